// Robots that follow a script, without any program.
#include "brain/script_brain.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "support/devices.hpp"

namespace pogosim {
namespace {

World robot_with(ScriptSpec const& script) {
    ObjectSpec spec = testing::pogobot_spec();
    spec.robot->brain = script;
    return testing::world_with_robot(spec);
}

void run_until(World& world, ScriptBrain& brain, std::int64_t step) {
    for (; world.step < step; ++world.step) {
        brain.run_step();
    }
}

TEST(ScriptBrain, DoesWhatItsListSaysAtTheFirstTickFromThenOn) {
    World world =
        robot_with({.entries = {{.time_s = 0.0, .motors = {100, -200, std::nullopt}},
                                {.time_s = 0.5, .led = Rgb{1, 2, 3}, .led_id = 4},
                                {.time_s = 1.0, .motors = {std::nullopt, 50, std::nullopt}, .message = "now"}}});
    ScriptBrain brain(world, 0);
    run_until(world, brain, 1);
    EXPECT_EQ(world.devices.motors[0].power, (std::array<std::uint16_t, kMotorCount>{100, 200, 0}));
    EXPECT_EQ(world.devices.motors[0].direction[1], 0);
    run_until(world, brain, 50);
    EXPECT_EQ(world.robots.led[0], Leds{});
    run_until(world, brain, 53);
    EXPECT_EQ(world.robots.led[0][4], (Rgb{1, 2, 3}));
    EXPECT_TRUE(world.air.transmissions.empty());
    run_until(world, brain, 103);
    EXPECT_EQ(world.devices.motors[0].power, (std::array<std::uint16_t, kMotorCount>{100, 50, 0}));
    ASSERT_EQ(world.air.transmissions.size(), 1U);
    EXPECT_EQ(std::memcmp(world.air.payloads.data(), "now", 3), 0);
    run_until(world, brain, 200);
    EXPECT_EQ(world.air.transmissions.size(), 1U);
}

TEST(ScriptBrain, TimeOfATickIsInTimeForItHoweverItIsRounded) {
    // 32.112 * 1e6 is a little more than 32112000.
    World world = robot_with({.entries = {{.time_s = 32.112, .message = "now"}}});
    ScriptBrain brain(world, 0);
    for (std::int64_t tick = 0; tick <= 2007; ++tick) {
        EXPECT_TRUE(world.air.transmissions.empty()) << tick;
        world.step = (tick * 16 + 9) / 10;  // the first step of 10 ms in which it is due
        brain.run_step();
    }
    EXPECT_EQ(world.air.transmissions.size(), 1U);
}

TEST(ScriptBrain, ForgetsMessagesThatArrive) {
    World world = robot_with({});
    ScriptBrain brain(world, 0);
    for (int i = 0; i < 3; ++i) {
        world.mailboxes.push(0, {}, {});
    }
    brain.run_step();
    EXPECT_TRUE(world.mailboxes.empty(0));
}

TEST(ScriptBrain, GoesOnFromWhereItWasSaved) {
    World world = robot_with({.entries = {{.time_s = 0.0, .message = "a"}, {.time_s = 1.0, .message = "b"}}});
    ScriptBrain brain(world, 0);
    run_until(world, brain, 10);
    auto const saved = brain.save();
    ScriptBrain other(world, 0);
    other.restore(*saved);
    world.air.clear();
    run_until(world, other, 200);
    EXPECT_EQ(world.air.payloads, (std::vector{std::byte{'b'}}));
}

}  // namespace
}  // namespace pogosim
