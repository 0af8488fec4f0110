// Messages on the air and received messages: plain data between the robots' programs and the communication stage.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/state_bytes.hpp"

namespace pogosim {

inline constexpr std::size_t kMostPayloadBytes = 382;

/// The eight bytes a receiver sees in front of a payload. Same fields as message_header_t of the C interface.
struct FrameHeader {
    std::uint8_t packet_type = 0;
    std::uint8_t emitting_power_list = 0;
    std::uint16_t sender_id = 0;
    std::uint8_t sender_ir_index = 0;
    std::uint8_t receiver_ir_index = 0;
    std::uint16_t payload_length = 0;

    friend bool operator==(FrameHeader const&, FrameHeader const&) = default;
};

/// What a packet means to the receiver's library, apart from its program, which gets all but malformed ones.
enum class PacketKind : std::uint8_t { message, malformed, mute, unmute, restart };

inline constexpr std::uint8_t kAllFaces = 0xF;  // bit d: emitter d

/// One transmission of one robot during this step.
struct Transmission {
    std::uint32_t robot = 0;    // index of the sender
    std::uint8_t emitters = 0;  // bit d: emitter d radiates
    PacketKind kind = PacketKind::message;
    std::uint16_t message_bytes = 0;  // header and payload as the reception law counts them
    float send_probability = 0.0F;    // of the sender, per tick
    float range_mm = 0.0F;            // from an emitter to the receiver's border
    FrameHeader header;
    std::size_t payload_offset = 0;  // into TransmissionQueue::payloads

    friend bool operator==(Transmission const&, Transmission const&) = default;
};

/// All transmissions of the current step, in the order in which the robots made them.
struct TransmissionQueue {
    std::vector<Transmission> transmissions;
    std::vector<std::byte> payloads;

    std::span<std::byte const> payload_of(Transmission const& transmission) const {
        return std::span(payloads).subspan(transmission.payload_offset, transmission.header.payload_length);
    }
    /// Adds those of another queue behind its own.
    void append(TransmissionQueue const& others);
    void clear() {
        transmissions.clear();
        payloads.clear();
    }

    friend bool operator==(TransmissionQueue const&, TransmissionQueue const&) = default;
};

/// A message taken out of a mailbox. Its payload stays there, until the next message arrives.
struct Message {
    FrameHeader header;
    std::span<std::byte const> payload;
};

/// Every robot's FIFO of received messages. Messages are stored contiguously in the robot's near block, a few cache
/// lines that begin with its counters; further ones go to its far block, which has room for a full queue of messages of
/// maximum length and takes no memory before it is used.
class Mailboxes {
public:
    Mailboxes() = default;

    /// `queue_sizes[i]` messages of up to `max_payload_bytes` for robot i; all queues empty.
    Mailboxes(std::span<int const> queue_sizes, std::size_t max_payload_bytes);

    // A copy takes as much memory as messages wait.
    Mailboxes(Mailboxes const& other);
    Mailboxes(Mailboxes&&) noexcept = default;
    Mailboxes& operator=(Mailboxes const& other) { return *this = Mailboxes(other); }
    Mailboxes& operator=(Mailboxes&&) noexcept = default;
    ~Mailboxes() = default;

    /// The same messages wait, and as many were lost.
    friend bool operator==(Mailboxes const& a, Mailboxes const& b);

    std::size_t robot_count() const { return queues_.size(); }

    /// Appends a message, or counts it as dropped and returns false when the queue is full.
    bool push(std::size_t robot, FrameHeader const& header, std::span<std::byte const> payload);

    /// Appends a copy for each of the faces (bit d: face d), lowest first, with the face in its header. Returns the
    /// number of copies that found room; the others count as dropped.
    unsigned push_copies(std::size_t robot, FrameHeader const& header, std::span<std::byte const> payload,
                         unsigned faces);

    /// Copies of a packet that arrive, one for each of the faces, as push_copies(): malformed ones are counted and not
    /// appended; of a command, the robot's library gets to know, too, even if the queue is full.
    unsigned deliver(std::size_t robot, FrameHeader const& header, std::span<std::byte const> payload, PacketKind kind,
                     unsigned faces) {
        if (kind != PacketKind::message) [[unlikely]] {
            return deliver_special(robot, header, payload, kind, faces);
        }
        return push_copies(robot, header, payload, faces);
    }

    /// Commands that have arrived and that the robot's library has not looked at.
    struct Commands {
        std::optional<bool> is_muted{};  // what the last one of these says
        bool restart = false;

        friend bool operator==(Commands const&, Commands const&) = default;
    };
    bool has_commands(std::size_t robot) const { return queues_[robot].has_commands != 0; }
    Commands take_commands(std::size_t robot);

    /// Prefetches the robot's counters and the start of its near block for a coming push.
    void expect_push(std::size_t robot) const { __builtin_prefetch(&queues_[robot], 1); }

    bool empty(std::size_t robot) const { return queues_[robot].waiting == 0; }
    int size(std::size_t robot) const { return static_cast<int>(queues_[robot].waiting); }

    /// Removes the oldest message. Absent: there is none.
    std::optional<Message> take(std::size_t robot) {
        Queue& queue = queues_[robot];
        if (queue.waiting == 0) {
            return std::nullopt;
        }
        --queue.waiting;
        if (queue.near.count > 0) {
            return queue.near.take(queue.near_block.data());
        }
        FarQueue& far = far_[robot];
        return far.fifo.take(far_blocks_.get() + far.block);
    }

    /// Headers and payloads of the waiting messages, oldest first, in two blocks.
    std::array<std::span<std::byte const>, 2> waiting(std::size_t robot) const;

    /// See state_bytes.hpp. Throws ForeignState for a state of other robots.
    void append_state(StateWriter& state) const;
    void take_state(StateReader& state);

    void clear(std::size_t robot) {
        if (!empty(robot)) {
            remove_all(robot);
        }
    }

    /// Messages lost to full queues since the start.
    std::uint64_t dropped(std::size_t robot) const { return dropped_[robot]; }

    /// Malformed packets that have arrived since the start.
    std::uint64_t malformed(std::size_t robot) const { return malformed_[robot]; }

private:
    /// Messages in a block of bytes.
    struct Fifo {
        std::uint32_t head = 0;  // first byte of the oldest message
        std::uint32_t tail = 0;  // one past the newest
        std::uint32_t count = 0;

        bool has_room(std::size_t bytes, std::size_t capacity) const { return tail - head + bytes <= capacity; }
        std::span<std::byte const> bytes(std::byte const* block) const { return {block + head, block + tail}; }
        [[gnu::noinline]] void move_to_front(std::byte* block);
        /// Returns where it lies: its header, then its payload.
        std::byte* push(std::byte* block, std::size_t capacity, FrameHeader const& header,
                        std::span<std::byte const> payload);
        Message take(std::byte const* block) {
            assert(count > 0 && head + sizeof(FrameHeader) <= tail);
            Message message;
            std::memcpy(&message.header, block + head, sizeof(FrameHeader));
            message.payload = {block + head + sizeof(FrameHeader), message.header.payload_length};
            head += static_cast<std::uint32_t>(sizeof(FrameHeader) + message.payload.size());
            if (--count == 0) {
                head = tail = 0;
            }
            return message;
        }
    };

    static constexpr std::size_t kCacheLine = 64;
    static constexpr std::size_t kNearBytes = 4 * kCacheLine - sizeof(Fifo) - 3 * sizeof(std::uint32_t);

    /// The data that most messages touch: a short message lies in the same cache line as the counters.
    struct alignas(kCacheLine) Queue {
        std::uint32_t waiting = 0;  // messages, near and far ones
        std::uint32_t max_count = 0;
        std::uint32_t has_commands = 0;  // 1: some in commands_
        Fifo near;
        std::array<std::byte, kNearBytes> near_block;
    };

    /// The newer messages, if there are many or long ones.
    struct FarQueue {
        Fifo fifo;
        std::size_t block = 0;     // offset in far_blocks_
        std::size_t capacity = 0;  // bytes
    };

    unsigned deliver_special(std::size_t robot, FrameHeader const& header, std::span<std::byte const> payload,
                             PacketKind kind, unsigned faces);
    void remove_all(std::size_t robot);
    std::size_t far_bytes() const { return far_.empty() ? 0 : far_.back().block + far_.back().capacity; }
    std::byte* append(Queue& queue, std::size_t robot, FrameHeader const& header, std::span<std::byte const> payload);
    [[gnu::noinline]] std::byte* append_far(std::size_t robot, FrameHeader const& header,
                                            std::span<std::byte const> payload);

    std::vector<Queue> queues_;
    std::vector<FarQueue> far_;
    std::vector<std::uint64_t> dropped_;
    std::vector<std::uint64_t> malformed_;
    std::vector<Commands> commands_;
    std::unique_ptr<std::byte[]> far_blocks_;
};

}  // namespace pogosim
