#include "world/mailbox.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <deque>
#include <span>
#include <utility>
#include <vector>

#include "base/random.hpp"

namespace pogosim {
namespace {

constexpr std::size_t kMaxPayload = 382;

std::vector<std::byte> payload_of(std::size_t size, int value) {
    return std::vector(size, static_cast<std::byte>(value));
}

bool push(Mailboxes& boxes, std::size_t robot, std::vector<std::byte> const& payload) {
    FrameHeader header;
    header.payload_length = static_cast<std::uint16_t>(payload.size());
    return boxes.push(robot, header, payload);
}

/// The payloads of messages in two contiguous parts.
std::vector<std::vector<std::byte>> payloads_of(std::array<std::span<std::byte const>, 2> const& messages) {
    std::vector<std::vector<std::byte>> payloads;
    for (std::span<std::byte const> part : messages) {
        while (!part.empty()) {
            FrameHeader header;
            std::memcpy(&header, part.data(), sizeof(header));
            std::span<std::byte const> const payload = part.subspan(sizeof(header), header.payload_length);
            payloads.emplace_back(payload.begin(), payload.end());
            part = part.subspan(sizeof(header) + payload.size());
        }
    }
    return payloads;
}

TEST(Mailbox, CopiesThatFindNoRoomAreCountedOneByOne) {
    std::array const sizes{3};
    Mailboxes boxes(sizes, kMaxPayload);
    EXPECT_EQ(boxes.push_copies(0, FrameHeader{}, {}, 0b0101), 2U);
    EXPECT_EQ(boxes.dropped(0), 0U);
    EXPECT_EQ(boxes.push_copies(0, FrameHeader{}, {}, 0b1111), 1U);
    EXPECT_EQ(boxes.dropped(0), 3U);
    EXPECT_EQ(boxes.push_copies(0, FrameHeader{}, {}, 0b1010), 0U);
    EXPECT_EQ(boxes.dropped(0), 5U);
    EXPECT_FALSE(push(boxes, 0, payload_of(1, 1)));
    EXPECT_EQ(boxes.dropped(0), 6U);
    // Those that found room name their faces, lowest first.
    for (int const face : {0, 2, 0}) {
        auto const message = boxes.take(0);
        ASSERT_TRUE(message);
        EXPECT_EQ(message->header.receiver_ir_index, face);
    }
}

TEST(Mailbox, GivesMessagesBackFirstInFirstOut) {
    std::array const sizes{3};
    Mailboxes boxes(sizes, kMaxPayload);
    EXPECT_TRUE(boxes.empty(0));
    push(boxes, 0, payload_of(2, 1));
    push(boxes, 0, payload_of(0, 0));
    push(boxes, 0, payload_of(382, 3));
    EXPECT_EQ(boxes.size(0), 3);
    for (auto const& [length, value] : {std::pair(2U, 1), std::pair(0U, 0), std::pair(382U, 3)}) {
        auto const message = boxes.take(0);
        ASSERT_TRUE(message);
        EXPECT_EQ(message->header.payload_length, length);
        ASSERT_EQ(message->payload.size(), length);
        EXPECT_TRUE(std::ranges::equal(message->payload, payload_of(length, value)));
    }
    EXPECT_FALSE(boxes.take(0));
}

TEST(Mailbox, BehavesAsAPlainQueueForAnySequenceOfMessages) {
    std::array const sizes{20, 1, 7};
    Mailboxes boxes(sizes, kMaxPayload);
    std::array<std::deque<std::vector<std::byte>>, 3> expected;
    RandomStream random(3, 3);
    for (int i = 0; i < 20000; ++i) {
        std::size_t const robot = random.below(3);
        if (random.below(2) == 0) {
            auto const message = payload_of(random.below(kMaxPayload + 1), i % 256);
            bool const fits = expected[robot].size() < static_cast<std::size_t>(sizes[robot]);
            EXPECT_EQ(push(boxes, robot, message), fits);
            if (fits) {
                expected[robot].push_back(message);
            }
        } else {
            auto const message = boxes.take(robot);
            ASSERT_EQ(message.has_value(), !expected[robot].empty());
            if (message) {
                EXPECT_TRUE(std::ranges::equal(message->payload, expected[robot].front()));
                expected[robot].pop_front();
            }
        }
        EXPECT_EQ(payloads_of(boxes.waiting(robot)), std::vector(expected[robot].begin(), expected[robot].end()));
    }
}

}  // namespace
}  // namespace pogosim
