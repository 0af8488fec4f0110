// What the channel says about each message: which robots were in range, through which faces, and the outcome.
#include "comms/delivery_log.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "comms/ir_channel.hpp"
#include "comms/reception.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_robot;
using testing::add_wall;
using testing::square_world;

ObjectSpec link_with_rate(double rate) {
    ObjectSpec spec = testing::pogobot_spec();
    spec.robot->ir.reception = {.law = ReceptionLaw::constant, .rate = rate};
    return spec;
}

void send(World& world, std::uint32_t robot, std::uint8_t emitters = kAllFaces) {
    std::array const payload{std::byte{7}, static_cast<std::byte>(robot)};
    testing::send(world, robot, payload, {.emitters = emitters});
}

TEST(DeliveryLog, FacesAndDistanceAreThoseOfRobotsPlacedByHand) {
    World world = square_world();
    add_robot(world, {500, 500}, 0.0F, link_with_rate(1.0));                    // looks along +x
    add_robot(world, {500, 600}, static_cast<float>(std::numbers::pi) / 2.0F);  // to its right, looks away from it
    add_robot(world, {500, 420},
              -static_cast<float>(std::numbers::pi) * 3 / 4.0F);  // to its left, turned by 45 degrees
    IrChannel channel;
    DeliveryLog log;
    send(world, 0);
    world.step = 17;
    channel.deliver(world, &log);
    EXPECT_EQ(log.step, 17);
    ASSERT_EQ(log.deliveries.size(), 2U);

    Delivery const& right = log.deliveries[0];
    EXPECT_EQ(right.receiver, 1U);
    EXPECT_EQ(right.emitters, 0b0010);  // right
    EXPECT_EQ(right.faces, 0b0100);     // at its back
    EXPECT_NEAR(right.distance_mm, 100.0 - 2.0 * 26.5, 1e-3);
    EXPECT_TRUE(right.is_received);
    EXPECT_EQ(right.queued, 1);
    EXPECT_EQ(right.cluster_size, 3U);
    EXPECT_EQ(right.probability, 1.0F);

    Delivery const& left = log.deliveries[1];
    EXPECT_EQ(left.receiver, 2U);
    EXPECT_EQ(left.emitters, 0b1000);  // left
    EXPECT_NEAR(left.distance_mm, 80.0 - 2.0 * 26.5, 1e-3);
    EXPECT_EQ(left.faces, 0b1100);  // at its back and its left, one copy each
    EXPECT_EQ(left.queued, 2);
    EXPECT_EQ(world.mailboxes.size(2), 2);
}

TEST(DeliveryLog, KeepsTransmissionsWithTheirPayloads) {
    World world = square_world();
    add_robot(world, {500, 500}, 0.0F, link_with_rate(1.0));
    add_robot(world, {580, 500});
    IrChannel channel;
    DeliveryLog log;
    send(world, 1);
    send(world, 0, 0b0001);
    channel.deliver(world, &log);
    ASSERT_EQ(log.air.transmissions.size(), 2U);
    EXPECT_EQ(log.air.transmissions[1].emitters, 0b0001);
    EXPECT_EQ(log.air.payload_of(log.air.transmissions[0])[1], std::byte{1});
    EXPECT_TRUE(world.air.transmissions.empty());
    EXPECT_TRUE(world.air.payloads.empty());

    // The next step replaces it.
    channel.deliver(world, &log);
    EXPECT_TRUE(log.deliveries.empty());
    EXPECT_TRUE(log.air.transmissions.empty());
}

TEST(DeliveryLog, MessageThatReachesNoRobotHasOneEntry) {
    World world = square_world();
    add_robot(world, {100, 100}, 0.0F, link_with_rate(1.0));
    add_robot(world, {900, 900});
    IrChannel channel;
    DeliveryLog log;
    send(world, 0);
    send(world, 1);
    channel.deliver(world, &log);
    ASSERT_EQ(log.deliveries.size(), 2U);
    EXPECT_EQ(log.deliveries[0].receiver, kNone);
    EXPECT_EQ(log.deliveries[1].receiver, kNone);
    EXPECT_EQ(log.deliveries[1].transmission, 1U);
    EXPECT_EQ(channel.attempts(), 0U);
}

TEST(DeliveryLog, FullQueueIsReceivedButNotQueued) {
    World world = square_world();
    add_robot(world, {500, 500}, 0.0F, link_with_rate(1.0));
    add_robot(world, {580, 500});
    IrChannel channel;
    DeliveryLog log;
    for (int i = 0; i < 25; ++i) {
        send(world, 0);
    }
    channel.deliver(world, &log);
    ASSERT_EQ(log.deliveries.size(), 25U);
    for (std::size_t i = 0; i < 25; ++i) {
        EXPECT_TRUE(log.deliveries[i].is_received);
        EXPECT_EQ(log.deliveries[i].queued, i < 20 ? 1 : 0) << i;
    }
    EXPECT_EQ(world.mailboxes.dropped(1), 5U);
}

TEST(DeliveryLog, LostMessagesHaveTheFacesThatWouldHaveReceivedThem) {
    World world = square_world();
    add_robot(world, {500, 500}, 0.0F, link_with_rate(0.0));
    add_robot(world, {580, 500});
    IrChannel channel;
    DeliveryLog log;
    send(world, 0);
    channel.deliver(world, &log);
    ASSERT_EQ(log.deliveries.size(), 1U);
    EXPECT_FALSE(log.deliveries[0].is_received);
    EXPECT_EQ(log.deliveries[0].faces, 0b0100);
    EXPECT_EQ(log.deliveries[0].queued, 0);
    EXPECT_TRUE(world.mailboxes.empty(1));
}

TEST(DeliveryLog, WallHasOneFaceAndNoDistance) {
    World world = square_world();
    add_robot(world, {60, 500}, 0.0F, link_with_rate(1.0));
    std::uint32_t const wall = add_wall(world, {{{0, 0}, {10, 0}, {10, 1000}, {0, 1000}}});
    world.mailboxes = Mailboxes(std::vector<int>{20, 20}, 382);
    IrChannel channel;
    DeliveryLog log;
    send(world, 0);
    channel.deliver(world, &log);
    ASSERT_EQ(log.deliveries.size(), 1U);
    EXPECT_EQ(log.deliveries[0].receiver, wall);
    EXPECT_EQ(log.deliveries[0].faces, 0b0001);
    EXPECT_TRUE(std::isnan(log.deliveries[0].distance_mm));
}

TEST(DeliveryLog, ChangesNothingInTheWorld) {
    auto const deliver_many = [](DeliveryLog* log) {
        World world = square_world();
        for (int i = 0; i < 6; ++i) {
            add_robot(world, {400.0F + 60.0F * static_cast<float>(i % 3), 500.0F + 70.0F * static_cast<float>(i / 3)},
                      static_cast<float>(i), link_with_rate(0.5));
        }
        IrChannel channel;
        for (int step = 0; step < 50; ++step) {
            for (std::uint32_t robot = 0; robot < 6; ++robot) {
                send(world, robot);
            }
            channel.deliver(world, log);
        }
        std::vector<double> state{static_cast<double>(channel.attempts()), static_cast<double>(channel.receptions())};
        for (std::uint32_t robot = 0; robot < 6; ++robot) {
            state.push_back(static_cast<double>(world.mailboxes.dropped(robot)));
            state.push_back(static_cast<double>(world.robots.stream[robot].uniform()));
        }
        return state;
    };
    DeliveryLog log;
    EXPECT_EQ(deliver_many(&log), deliver_many(nullptr));
}

}  // namespace
}  // namespace pogosim
