#include "comms/ir_channel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "comms/reception.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_robot;
using testing::square_world;

ObjectSpec perfect_link() {
    ObjectSpec spec = testing::pogobot_spec();
    spec.robot->ir.reception = {.law = ReceptionLaw::constant, .rate = 1.0};
    return spec;
}

void send(World& world, std::uint32_t robot, std::vector<std::uint8_t> const& payload,
          std::uint8_t emitters = kAllFaces) {
    testing::send(world, robot, std::as_bytes(std::span(payload)), {.emitters = emitters});
}

struct Received {
    FrameHeader header;
    std::array<std::byte, kMostPayloadBytes> payload{};
};

std::vector<Received> take_all(World& world, std::uint32_t robot) {
    std::vector<Received> messages;
    while (auto const message = world.mailboxes.take(robot)) {
        messages.push_back({.header = message->header});
        std::ranges::copy(message->payload, messages.back().payload.begin());
    }
    return messages;
}

TEST(IrChannel, MessageArrivesWithItsPayloadAndFace) {
    World world = square_world();
    add_robot(world, {500, 500}, 0.0F, perfect_link());
    add_robot(world, {580, 500});
    IrChannel channel;
    send(world, 0, {1, 2, 3});
    channel.deliver(world);
    auto const messages = take_all(world, 1);
    ASSERT_EQ(messages.size(), 1U);
    EXPECT_EQ(messages[0].header.receiver_ir_index, 2);  // its back is turned to the sender
    EXPECT_EQ(messages[0].header.payload_length, 3);
    EXPECT_EQ(messages[0].payload[2], std::byte{3});
    EXPECT_TRUE(take_all(world, 0).empty());
    EXPECT_TRUE(world.air.transmissions.empty());
}

TEST(IrChannel, MessagesArriveInTheOrderInWhichTheyWereSent) {
    World world = square_world();
    add_robot(world, {500, 500}, 0.0F, perfect_link());
    add_robot(world, {580, 500});
    add_robot(world, {660, 500});
    IrChannel channel;
    send(world, 0, {1});
    send(world, 2, {2});
    send(world, 0, {3});
    channel.deliver(world);
    std::vector<int> order;
    for (Received const& message : take_all(world, 1)) {
        order.push_back(static_cast<int>(message.payload[0]));
    }
    EXPECT_EQ(order, (std::vector<int>{1, 2, 3}));
}

TEST(IrChannel, FullQueueDropsTheNewestAndCountsThem) {
    World world = square_world();
    add_robot(world, {500, 500}, 0.0F, perfect_link());
    add_robot(world, {580, 500});
    IrChannel channel;
    for (std::uint8_t i = 0; i < 25; ++i) {
        send(world, 0, {i});
    }
    channel.deliver(world);
    EXPECT_EQ(world.mailboxes.dropped(1), 5U);
    auto const messages = take_all(world, 1);
    ASSERT_EQ(messages.size(), 20U);
    EXPECT_EQ(messages.front().payload[0], std::byte{0});
    EXPECT_EQ(messages.back().payload[0], std::byte{19});
}

TEST(IrChannel, ShareOfReceivedMessagesIsTheReceptionProbability) {
    World world = square_world();
    add_robot(world, {500, 500});  // the article's law
    add_robot(world, {580, 500});
    add_robot(world, {420, 500});
    IrChannel channel;
    int const messages = 20000;
    for (int i = 0; i < messages; ++i) {
        send(world, 0, std::vector<std::uint8_t>(100));
        channel.deliver(world);
        world.mailboxes.clear(1);
        world.mailboxes.clear(2);
    }
    double const expected = reception_probability({}, 103, 1.0, 3);
    double const share = static_cast<double>(channel.receptions()) / static_cast<double>(channel.attempts());
    EXPECT_EQ(channel.attempts(), 2U * messages);
    EXPECT_NEAR(share, expected, 4.0 * std::sqrt(expected * (1.0 - expected) / (2.0 * messages)));
}

}  // namespace
}  // namespace pogosim
