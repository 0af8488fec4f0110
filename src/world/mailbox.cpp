#include "world/mailbox.hpp"

#include <cstring>

namespace pogosim {

namespace {

constexpr std::size_t kHeaderBytes = sizeof(FrameHeader);

}  // namespace

Mailboxes::Mailboxes(std::span<int const> queue_sizes, std::size_t max_payload_bytes) {
    std::size_t total = 0;
    queues_.reserve(queue_sizes.size());
    for (int const max_count : queue_sizes) {
        std::size_t const capacity = static_cast<std::size_t>(max_count) * (kHeaderBytes + max_payload_bytes);
        queues_.push_back({.block = total, .capacity = capacity, .max_count = max_count});
        total += capacity;
    }
    storage_ = std::make_unique_for_overwrite<std::byte[]>(total);
}

bool Mailboxes::push(std::size_t robot, FrameHeader const& header, std::span<std::byte const> payload) {
    Queue& queue = queues_[robot];
    if (queue.count == queue.max_count) {
        ++queue.dropped;
        return false;
    }
    std::byte* const block = storage_.get() + queue.block;
    std::size_t const needed = kHeaderBytes + payload.size();
    if (queue.tail + needed > queue.capacity) {
        // The block holds max_count of the longest messages, so there is room once the read ones are gone.
        std::memmove(block, block + queue.head, queue.tail - queue.head);
        queue.tail -= queue.head;
        queue.head = 0;
    }
    std::memcpy(block + queue.tail, &header, kHeaderBytes);
    if (!payload.empty()) {
        std::memcpy(block + queue.tail + kHeaderBytes, payload.data(), payload.size());
    }
    queue.tail += needed;
    ++queue.count;
    return true;
}

bool Mailboxes::pop(std::size_t robot, FrameHeader& header, std::byte* payload) {
    Queue& queue = queues_[robot];
    if (queue.count == 0) {
        return false;
    }
    std::byte const* const message = storage_.get() + queue.block + queue.head;
    std::memcpy(&header, message, kHeaderBytes);
    std::memcpy(payload, message + kHeaderBytes, header.payload_length);
    queue.head += kHeaderBytes + header.payload_length;
    --queue.count;
    if (queue.count == 0) {
        queue.head = queue.tail = 0;
    }
    return true;
}

void Mailboxes::clear(std::size_t robot) {
    Queue& queue = queues_[robot];
    queue.head = queue.tail = 0;
    queue.count = 0;
}

}  // namespace pogosim
