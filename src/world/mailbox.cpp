#include "world/mailbox.hpp"

#include <cassert>
#include <cstring>

namespace pogosim {

namespace {

constexpr std::size_t kHeaderBytes = sizeof(FrameHeader);

}  // namespace

void Mailboxes::Fifo::push(std::byte* block, std::size_t capacity, FrameHeader const& header,
                           std::span<std::byte const> payload) {
    std::size_t const needed = kHeaderBytes + payload.size();
    if (tail + needed > capacity) {
        // There is room once the messages already read are gone.
        std::memmove(block, block + head, tail - head);
        tail -= head;
        head = 0;
    }
    assert(tail + needed <= capacity);
    std::memcpy(block + tail, &header, kHeaderBytes);
    if (!payload.empty()) {
        std::memcpy(block + tail + kHeaderBytes, payload.data(), payload.size());
    }
    tail += static_cast<std::uint32_t>(needed);
    ++count;
}

void Mailboxes::Fifo::pop(std::byte const* block, FrameHeader& header, std::byte* payload) {
    assert(count > 0 && head + kHeaderBytes <= tail);
    std::memcpy(&header, block + head, kHeaderBytes);
    std::memcpy(payload, block + head + kHeaderBytes, header.payload_length);
    head += static_cast<std::uint32_t>(kHeaderBytes + header.payload_length);
    if (--count == 0) {
        head = tail = 0;
    }
}

Mailboxes::Mailboxes(std::span<int const> queue_sizes, std::size_t max_payload_bytes) : queues_(queue_sizes.size()) {
    std::size_t total = 0;
    for (std::size_t i = 0; i < queues_.size(); ++i) {
        Queue& queue = queues_[i];
        queue.max_count = static_cast<std::uint32_t>(queue_sizes[i]);
        queue.far_block = total;
        queue.far_capacity = queue.max_count * (kHeaderBytes + max_payload_bytes);
        total += queue.far_capacity;
    }
    far_blocks_ = std::make_unique_for_overwrite<std::byte[]>(total);
}

bool Mailboxes::push(std::size_t robot, FrameHeader const& header, std::span<std::byte const> payload) {
    assert(robot < queues_.size() && payload.size() == header.payload_length);
    Queue& queue = queues_[robot];
    if (queue.near.count + queue.far.count == queue.max_count) {
        ++queue.dropped;
        return false;
    }
    // Once a message lies far, the next ones do too, so that all near ones are older.
    if (queue.far.count == 0 && queue.near.has_room(kHeaderBytes + payload.size(), kNearBytes)) {
        queue.near.push(queue.near_block.data(), kNearBytes, header, payload);
    } else {
        queue.far.push(far_blocks_.get() + queue.far_block, queue.far_capacity, header, payload);
    }
    return true;
}

bool Mailboxes::pop(std::size_t robot, FrameHeader& header, std::byte* payload) {
    Queue& queue = queues_[robot];
    if (queue.near.count > 0) {
        queue.near.pop(queue.near_block.data(), header, payload);
        return true;
    }
    if (queue.far.count > 0) {
        queue.far.pop(far_blocks_.get() + queue.far_block, header, payload);
        return true;
    }
    return false;
}

std::array<std::span<std::byte const>, 2> Mailboxes::waiting(std::size_t robot) const {
    Queue const& queue = queues_[robot];
    return {queue.near.bytes(queue.near_block.data()), queue.far.bytes(far_blocks_.get() + queue.far_block)};
}

void Mailboxes::clear(std::size_t robot) {
    queues_[robot].near = {};
    queues_[robot].far = {};
}

}  // namespace pogosim
