// Robots that a host drives by arrays, without any program.
#include "brain/host_brain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string_view>

#include "config/config_file.hpp"
#include "device/clock.hpp"
#include "support/devices.hpp"

namespace pogosim {
namespace {

World two_robots() {
    World world = testing::square_world();
    testing::add_robot(world, {400, 500});
    testing::add_robot(world, {600, 500});
    set_up_devices(world, 1);
    world.light = {.columns = 1, .rows = 1, .origin_mm = {0, 0}, .cell_mm = {1000, 1000}, .level = {0}};
    return world;
}

World one_robot(ObjectSpec const& spec = testing::pogobot_spec()) {
    World world = testing::world_with_robot(spec);
    world.light = {.columns = 1, .rows = 1, .origin_mm = {0, 0}, .cell_mm = {1000, 1000}, .level = {0}};
    return world;
}

void write_message(HostBrain& brain, std::size_t robot, std::string_view text) {
    std::memcpy(brain.inputs().send_bytes[robot].data(), text.data(), text.size());
    brain.inputs().send_length[robot] = static_cast<std::int32_t>(text.size());
}

/// Steps until every robot has ticked again.
void tick(World& world, HostBrain& brain) {
    world.step += 2;
    brain.run_step();
}

TEST(HostBrain, RobotsTickAt60HzOfTheirClocks) {
    World world = two_robots();
    world.devices.clock_drift_us[1] = 16'000;  // half as often
    HostBrain brain(world, "robots", robots_of(world, 0));
    for (; world.step < 800; ++world.step) {  // 8 s
        brain.run_step();
    }
    EXPECT_EQ(world.devices.ticks[0], 500U);
    EXPECT_EQ(world.devices.ticks[1], 250U);
}

TEST(HostBrain, PositivePowersAreForwardAndBeyondTheMostAreFull) {
    World world = two_robots();
    HostBrain brain(world, "robots", robots_of(world, 0));
    brain.inputs().motors[0] = {5000, 1023, 0};
    brain.inputs().motors[1] = {-512, -512, 0};
    brain.run_step();
    float const most = world.spec_of(0).max_linear_speed_mm_s;
    EXPECT_FLOAT_EQ(world.robots.command[0].velocity_mm_s.x, most);
    EXPECT_FLOAT_EQ(world.robots.command[1].velocity_mm_s.x, -most * 512.0F / 1023.0F);
    EXPECT_FLOAT_EQ(world.robots.command[1].angular_velocity_rad_s, 0.0F);
}

TEST(HostBrain, FirstValueBeyondWhatARobotTakesIsWarnedOfWithItsRobot) {
    World world = two_robots();
    HostBrain brain(world, "robots", robots_of(world, 0));
    config_file::Warnings const warnings;
    brain.inputs().motors[0] = {1023, -1023, 0};
    brain.inputs().motors[1] = {5, -1024, 0};
    write_message(brain, 1, "abc");
    brain.inputs().send_length[1] = 383;
    brain.run_step();
    EXPECT_EQ(warnings.text(),
              "brain of category 'robots': motors[1, 1] is -1024, expected -1023 to 1023; -1023 is used\n"
              "brain of category 'robots': send_length[1] is 383, expected at most 382 bytes; 382 are sent\n");
    brain.inputs().motors[0] = {5000, 5000, 7};
    write_message(brain, 0, "abc");
    brain.inputs().send_face[0] = 4;
    tick(world, brain);
    ASSERT_EQ(warnings.lines().size(), 4U);
    EXPECT_EQ(warnings.lines()[2],
              "brain of category 'robots': motors[:, 2]: the robots' model has no such motor; its power moves nothing");
    EXPECT_EQ(warnings.lines()[3],
              "brain of category 'robots': send_face[0] is 4, expected -1 to 3; all directions are used");
}

TEST(HostBrain, MotorsThatWereNeverSetLeaveTheirRobotAloneAndThenHoldIt) {
    World world = two_robots();
    HostBrain brain(world, "robots", robots_of(world, 0));
    brain.run_step();
    EXPECT_FALSE(world.robots.command[0].pending);
    brain.inputs().motors[0] = {1, 0, 0};
    tick(world, brain);
    world.robots.command[0] = {};
    brain.inputs().motors[0] = {};
    tick(world, brain);
    EXPECT_TRUE(world.robots.command[0].pending);
    EXPECT_EQ(world.robots.command[0].velocity_mm_s, Vec2());
}

TEST(HostBrain, MessageIsSentOnceAtTheNextTick) {
    World world = two_robots();
    HostBrain brain(world, "robots", robots_of(world, 0));
    write_message(brain, 1, "hello");
    brain.inputs().send_face[1] = 3;
    brain.run_step();
    ASSERT_EQ(world.air.transmissions.size(), 1U);
    EXPECT_EQ(world.air.transmissions[0].robot, 1U);
    EXPECT_EQ(world.air.transmissions[0].emitters, 1U << 3U);
    EXPECT_EQ(std::memcmp(world.air.payloads.data(), "hello", 5), 0);
    EXPECT_EQ(brain.inputs().send_length[1], -1);
    tick(world, brain);
    EXPECT_EQ(world.air.transmissions.size(), 1U);
    EXPECT_EQ(world.devices.messages_sent[1], 1U);
}

TEST(HostBrain, ReceivedMessagesAreATableAndWaitWhenItIsFull) {
    World world = two_robots();
    HostBrain brain(world, "robots", robots_of(world, 0));
    std::array<std::byte, 2> const payload{std::byte{7}, std::byte{8}};
    auto const arrive = [&](std::uint16_t sender) {
        world.mailboxes.push(1, {.sender_id = sender, .receiver_ir_index = 2, .payload_length = 2}, payload);
    };
    arrive(40);
    arrive(41);
    brain.run_step();
    ASSERT_EQ(brain.received().size(), 2U);
    HostBrain::Received const& second = brain.received()[1];
    EXPECT_EQ(second.robot, 1);
    EXPECT_EQ(second.sender, 41);
    EXPECT_EQ(second.face, 2);
    EXPECT_EQ(second.length, 2);
    EXPECT_EQ(brain.received_bytes()[static_cast<std::size_t>(second.offset) + 1], std::byte{8});
    EXPECT_EQ(brain.outputs().received_count[1], 2U);
    int const room = 2 * world.spec_of(0).ir.queue_size;
    for (int i = 0; i < room; ++i) {
        arrive(50);
        tick(world, brain);
    }
    EXPECT_EQ(brain.received().size(), static_cast<std::size_t>(room));
    EXPECT_EQ(world.mailboxes.size(1), 2);
    auto const* const place = brain.received().data();
    brain.clear_received();
    EXPECT_TRUE(brain.received().empty());
    EXPECT_EQ(brain.outputs().received_count[1], 0U);
    tick(world, brain);
    EXPECT_EQ(brain.received().size(), 2U);
    EXPECT_EQ(brain.received().data(), place);
}

TEST(HostBrain, RobotThatIsMutedOrSwitchedOffSendsNothing) {
    World world = two_robots();
    HostBrain brain(world, "robots", robots_of(world, 0));
    world.devices.infrared[0].is_muted = 1;
    world.devices.clock_us[1] = kNever;
    write_message(brain, 0, "a");
    write_message(brain, 1, "b");
    brain.run_step();
    EXPECT_TRUE(world.air.transmissions.empty());
    EXPECT_EQ(world.devices.infrared[0].muted_messages, 1U);
    EXPECT_EQ(brain.inputs().send_length[1], 1) << "it waits until the robot is switched on";
}

/// Two faces, one LED, no light sensor, and a left motor that is mounted the other way round.
World poor_robot() {
    ObjectSpec spec = testing::pogobot_spec();
    RobotModel& model = spec.robot->model;
    model.faces.resize(2);
    model.leds.resize(1);
    model.light_sensors.clear();
    model.drives[1].forward = 0;
    return one_robot(spec);
}

TEST(HostBrain, RobotOfAnotherModelDoesWhatItCan) {
    World world = poor_robot();
    HostBrain brain(world, "robots", robots_of(world, 0));
    brain.inputs().motors[0] = {500, 500, 0};
    brain.inputs().leds[0].fill({1, 2, 3});
    write_message(brain, 0, "all");
    brain.run_step();
    EXPECT_GT(world.robots.command[0].velocity_mm_s.x, 0.0F);
    EXPECT_EQ(world.robots.command[0].angular_velocity_rad_s, 0.0F);
    EXPECT_EQ(world.robots.led[0][0], (Rgb{1, 2, 3}));
    EXPECT_EQ(world.robots.led[0][1], Rgb{});
    EXPECT_EQ(brain.outputs().photosensors[0][0], -1);
    ASSERT_EQ(world.air.transmissions.size(), 1U);
    EXPECT_EQ(world.air.transmissions[0].emitters, 0b11);
    brain.inputs().send_face[0] = 3;  // which it does not have
    write_message(brain, 0, "left");
    tick(world, brain);
    EXPECT_EQ(world.air.transmissions.size(), 1U);
}

TEST(HostBrain, MessageThatIsTooLongIsCut) {
    World world = one_robot();
    HostBrain brain(world, "robots", robots_of(world, 0));
    brain.inputs().send_length[0] = 5000;
    brain.run_step();
    ASSERT_EQ(world.air.transmissions.size(), 1U);
    EXPECT_EQ(world.air.transmissions[0].header.payload_length, kMostPayloadBytes);
}

TEST(HostBrain, RobotObeysTheRemoteControl) {
    World world = one_robot();
    HostBrain brain(world, "robots", robots_of(world, 0));
    world.devices.ticks[0] = 100;
    world.mailboxes.deliver(0, {}, {}, PacketKind::restart, 1U);
    brain.run_step();
    EXPECT_EQ(world.devices.infrared[0].restarts, 1U);
    EXPECT_EQ(world.devices.ticks[0], 1U);
    world.mailboxes.deliver(0, {}, {}, PacketKind::mute, 1U);
    write_message(brain, 0, "a");
    tick(world, brain);
    EXPECT_TRUE(world.air.transmissions.empty());
}

TEST(HostBrain, AccelerationIsThatBetweenTicks) {
    World world = one_robot();
    HostBrain brain(world, "robots", robots_of(world, 0));
    brain.run_step();
    Bodies& bodies = world.bodies;
    bodies.start_mm[0] = bodies.position_mm[0];
    bodies.position_mm[0].x += 1.0F;  // in a step of 10 ms: from 0 to 100 mm/s
    tick(world, brain);
    EXPECT_NEAR(brain.outputs().acceleration[0][1], 0.1F / 0.016F, 1e-2F);
}

TEST(HostBrain, GoesOnFromWhatItHasSaved) {
    World world = two_robots();
    HostBrain brain(world, "robots", robots_of(world, 0));
    brain.inputs().motors[1] = {100, 200, 300};
    world.mailboxes.push(0, {.sender_id = 9, .payload_length = 0}, {});
    brain.run_step();
    auto const saved = brain.save();
    HostBrain other(world, "robots", robots_of(world, 0));
    other.restore(*saved);
    EXPECT_EQ(other.inputs().motors[1], brain.inputs().motors[1]);
    ASSERT_EQ(other.received().size(), 1U);
    EXPECT_EQ(other.received()[0].sender, 9);
}

}  // namespace
}  // namespace pogosim
