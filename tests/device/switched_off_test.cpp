// Robots that are switched off, and clocks, without any program.
#include "device/switched_off.hpp"

#include <gtest/gtest.h>

#include "device/clock.hpp"
#include "device/leds.hpp"
#include "device/motors.hpp"
#include "device/set_up.hpp"
#include "device/step_chips.hpp"
#include "support/devices.hpp"

namespace pogosim {
namespace {

TEST(SwitchedOff, RobotIsDarkAndNeverDueAndGoesOnAtItsOwnTimeOrNow) {
    World world = testing::world_with_robot();
    set_led(world, 0, 2, {1, 2, 3});
    world.devices.clock_us[0] = 70'000;
    set_alive(world, 0, false);
    EXPECT_FALSE(is_alive(world, 0));
    EXPECT_EQ(world.robots.led[0], Leds{});
    EXPECT_EQ(world.devices.clock_us[0], kNever);
    EXPECT_EQ(clock_us(world, 0), 70'000);
    set_alive(world, 0, true);
    EXPECT_EQ(world.devices.clock_us[0], 70'000);
    EXPECT_EQ(world.robots.led[0][2], (Rgb{1, 2, 3}));
    set_alive(world, 0, false);
    world.step = 100;  // t = 1 s
    set_alive(world, 0, true);
    EXPECT_EQ(world.devices.clock_us[0], 1'000'000);
}

TEST(SwitchedOff, MotorsHoldTheBody) {
    World world = testing::world_with_robot();
    set_motor_power(world, 0, 0, kFullMotorPower);
    set_alive(world, 0, false);
    hold_switched_off(world);
    EXPECT_TRUE(world.robots.command[0].pending);
    EXPECT_EQ(world.robots.command[0].velocity_mm_s, Vec2());
}

TEST(Clock, DriftsAtEachTickAndNeverTurnsBack) {
    World world = testing::world_with_robot();
    world.devices.clock_us[0] = 16'000;
    world.devices.clock_drift_us[0] = 25;
    drift_clock(world, 0, 0);
    EXPECT_EQ(world.devices.clock_us[0], 16'025);
    world.devices.clock_drift_us[0] = -1'000'000;
    drift_clock(world, 0, 16'000);
    EXPECT_GE(world.devices.clock_us[0], 16'000);
}

TEST(StepChips, BatteryIsEmptyAfterItsChargeDividedByItsCurrent) {
    ObjectSpec spec = testing::pogobot_spec();
    spec.robot->battery = {.capacity_mah = 100.0 / 3600.0, .idle_ma = 50.0, .motor_ma = 0.0, .led_ma = 0.0};
    World world = testing::world_with_robot(spec);
    StepChips chips(world);
    std::int64_t now_us = 0;
    while (chips.begin_step(world, now_us).empty()) {
        now_us += 10'000;
    }
    EXPECT_NEAR(static_cast<double>(now_us) * 1e-6, 2.0, 0.011);  // 100 mA s at 50 mA
}

TEST(Reset, ClearsPowersAndLedsAndKeepsWhatIsStored) {
    World world = testing::world_with_robot();
    world.devices.motors[0].stored_direction = {1, 1, 1};
    world.devices.motors[0].bias = 3.0F;
    set_motor_power(world, 0, 1, kFullMotorPower);
    set_led(world, 0, 0, {9, 9, 9});
    world.mailboxes.push(0, {}, {});
    reset_devices(world, 0, 5'000);
    EXPECT_EQ(world.devices.motors[0].power, (std::array<std::uint16_t, kMotorCount>{}));
    EXPECT_EQ(world.devices.motors[0].direction, (std::array<std::uint8_t, kMotorCount>{1, 1, 1}));
    EXPECT_EQ(world.devices.motors[0].bias, 3.0F);
    EXPECT_EQ(world.robots.led[0], Leds{});
    EXPECT_TRUE(world.mailboxes.empty(0));
    EXPECT_EQ(world.devices.clock_us[0], 5'000);
    EXPECT_EQ(world.devices.infrared[0].restarts, 1U);
}

}  // namespace
}  // namespace pogosim
