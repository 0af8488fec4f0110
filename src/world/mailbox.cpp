#include "world/mailbox.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <utility>

#include "base/four.hpp"

namespace pogosim {

namespace {

constexpr std::size_t kHeaderBytes = sizeof(FrameHeader);

}  // namespace

/// Overwrites the messages that have been read, which makes room.
void Mailboxes::Fifo::move_to_front(std::byte* block) {
    std::memmove(block, block + head, tail - head);
    tail -= head;
    head = 0;
}

inline std::byte* Mailboxes::Fifo::push(std::byte* block, std::size_t capacity, FrameHeader const& header,
                                        std::span<std::byte const> payload) {
    std::size_t const needed = kHeaderBytes + payload.size();
    if (tail + needed > capacity) [[unlikely]] {
        move_to_front(block);
    }
    assert(tail + needed <= capacity);
    std::byte* const message = block + tail;
    std::memcpy(message, &header, kHeaderBytes);
    if (!payload.empty()) {
        std::memcpy(message + kHeaderBytes, payload.data(), payload.size());
    }
    tail += static_cast<std::uint32_t>(needed);
    ++count;
    return message;
}

void TransmissionQueue::append(TransmissionQueue const& others) {
    std::size_t const offset = payloads.size();
    for (Transmission transmission : others.transmissions) {
        transmission.payload_offset += offset;
        transmissions.push_back(transmission);
    }
    payloads.insert(payloads.end(), others.payloads.begin(), others.payloads.end());
}

Mailboxes::Mailboxes(std::span<int const> queue_sizes, std::size_t max_payload_bytes)
    : queues_(queue_sizes.size()),
      far_(queue_sizes.size()),
      dropped_(queue_sizes.size()),
      malformed_(queue_sizes.size()),
      commands_(queue_sizes.size()) {
    std::size_t total = 0;
    for (std::size_t i = 0; i < queues_.size(); ++i) {
        queues_[i].max_count = static_cast<std::uint32_t>(queue_sizes[i]);
        far_[i].block = total;
        far_[i].capacity = queues_[i].max_count * (kHeaderBytes + max_payload_bytes);
        total += far_[i].capacity;
    }
    far_blocks_ = std::make_unique_for_overwrite<std::byte[]>(total);
}

Mailboxes::Mailboxes(Mailboxes const& other)
    : queues_(other.queues_),
      far_(other.far_),
      dropped_(other.dropped_),
      malformed_(other.malformed_),
      commands_(other.commands_),
      far_blocks_(std::make_unique_for_overwrite<std::byte[]>(far_bytes())) {
    for (FarQueue const& far : far_) {
        std::ranges::copy(far.fifo.bytes(other.far_blocks_.get() + far.block),
                          far_blocks_.get() + far.block + far.fifo.head);
    }
}

bool operator==(Mailboxes const& a, Mailboxes const& b) {
    if (a.queues_.size() != b.queues_.size() || a.dropped_ != b.dropped_ || a.malformed_ != b.malformed_ ||
        a.commands_ != b.commands_) {
        return false;
    }
    for (std::size_t robot = 0; robot < a.queues_.size(); ++robot) {
        if (a.queues_[robot].max_count != b.queues_[robot].max_count || a.size(robot) != b.size(robot)) {
            return false;
        }
        // Where a message lies, near or far, depends on what has been read before.
        auto const [a_near, a_far] = a.waiting(robot);
        auto const [b_near, b_far] = b.waiting(robot);
        if (a_near.size() + a_far.size() != b_near.size() + b_far.size()) {
            return false;
        }
        auto const byte = [](auto const& near, auto const& far, std::size_t i) {
            return i < near.size() ? near[i] : far[i - near.size()];
        };
        for (std::size_t i = 0; i < a_near.size() + a_far.size(); ++i) {
            if (byte(a_near, a_far, i) != byte(b_near, b_far, i)) {
                return false;
            }
        }
    }
    return true;
}

inline std::byte* Mailboxes::append(Queue& queue, std::size_t robot, FrameHeader const& header,
                                    std::span<std::byte const> payload) {
    // Once a message is in the far block, so are all later ones: messages in the near block are older.
    bool const all_near = queue.waiting == queue.near.count;
    ++queue.waiting;
    if (all_near && queue.near.has_room(kHeaderBytes + payload.size(), kNearBytes)) [[likely]] {
        return queue.near.push(queue.near_block.data(), kNearBytes, header, payload);
    }
    return append_far(robot, header, payload);
}

std::byte* Mailboxes::append_far(std::size_t robot, FrameHeader const& header, std::span<std::byte const> payload) {
    FarQueue& far = far_[robot];
    return far.fifo.push(far_blocks_.get() + far.block, far.capacity, header, payload);
}

bool Mailboxes::push(std::size_t robot, FrameHeader const& header, std::span<std::byte const> payload) {
    assert(robot < queues_.size() && payload.size() == header.payload_length);
    Queue& queue = queues_[robot];
    if (queue.waiting == queue.max_count) {
        ++dropped_[robot];
        return false;
    }
    append(queue, robot, header, payload);
    return true;
}

unsigned Mailboxes::push_copies(std::size_t robot, FrameHeader const& header, std::span<std::byte const> payload,
                                unsigned faces) {
    assert(robot < queues_.size() && payload.size() == header.payload_length);
    Queue& queue = queues_[robot];
    unsigned const before = queue.waiting;
    for (; faces != 0; faces &= faces - 1) {
        if (queue.waiting == queue.max_count) {
            dropped_[robot] += count_of_four(faces);
            break;
        }
        // Set in the copy: a load of the whole header right after a store of one byte of it would have to wait.
        append(queue, robot, header, payload)[offsetof(FrameHeader, receiver_ir_index)] =
            static_cast<std::byte>(std::countr_zero(faces));
    }
    return queue.waiting - before;
}

unsigned Mailboxes::deliver_special(std::size_t robot, FrameHeader const& header, std::span<std::byte const> payload,
                                    PacketKind kind, unsigned faces) {
    if (kind == PacketKind::malformed) {
        malformed_[robot] += count_of_four(faces);
        return 0;
    }
    Commands& commands = commands_[robot];
    if (kind == PacketKind::restart) {
        commands.restart = true;
    } else {
        commands.is_muted = kind == PacketKind::mute;
    }
    queues_[robot].has_commands = 1;
    return push_copies(robot, header, payload, faces);
}

Mailboxes::Commands Mailboxes::take_commands(std::size_t robot) {
    queues_[robot].has_commands = 0;
    return std::exchange(commands_[robot], {});
}

std::array<std::span<std::byte const>, 2> Mailboxes::waiting(std::size_t robot) const {
    Queue const& queue = queues_[robot];
    FarQueue const& far = far_[robot];
    return {queue.near.bytes(queue.near_block.data()), far.fifo.bytes(far_blocks_.get() + far.block)};
}

void Mailboxes::append_state(StateWriter& state) const {
    state(queues_, far_, dropped_, malformed_, commands_);
    for (FarQueue const& far : far_) {
        state.add_bytes(far.fifo.bytes(far_blocks_.get() + far.block));
    }
}

void Mailboxes::take_state(StateReader& state) {
    std::size_t const robots = queues_.size();
    std::size_t const bytes = far_bytes();
    state(queues_, far_, dropped_, malformed_, commands_);
    if (queues_.size() != robots || far_.size() != robots || far_bytes() != bytes) {
        throw ForeignState("its robots have other queues of messages");
    }
    for (FarQueue const& far : far_) {
        std::span const messages = state.take_bytes(far.fifo.tail - far.fifo.head);
        std::ranges::copy(messages, far_blocks_.get() + far.block + far.fifo.head);
    }
}

void Mailboxes::remove_all(std::size_t robot) {
    queues_[robot].waiting = 0;
    queues_[robot].near = {};
    far_[robot].fifo = {};
}

}  // namespace pogosim
