// Motors, without any program.
#include "device/motors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/devices.hpp"

namespace pogosim {
namespace {

constexpr int kRight = 0;
constexpr int kLeft = 1;
constexpr int kBack = 2;

TEST(Motors, BothAtFullPowerCommandTheMaximalSpeedAlongTheHeading) {
    World world = testing::world_with_robot();
    set_motor_power(world, 0, kRight, kFullMotorPower);
    set_motor_power(world, 0, kLeft, kFullMotorPower);
    drive(world, 0);
    VelocityCommand const& command = world.robots.command[0];
    EXPECT_TRUE(command.pending);
    EXPECT_FLOAT_EQ(command.velocity_mm_s.x, world.spec_of(0).max_linear_speed_mm_s);
    EXPECT_FLOAT_EQ(command.velocity_mm_s.y, 0.0F);
    EXPECT_FLOAT_EQ(command.angular_velocity_rad_s, 0.0F);
}

TEST(Motors, PowersBeyondFullAreFullAndDirectionsAreBits) {
    World world = testing::world_with_robot();
    set_motor_power(world, 0, kBack, UINT16_MAX);
    EXPECT_EQ(world.devices.motors[0].power[kBack], kFullMotorPower);
    EXPECT_EQ(motor_directions(world, 0), 0b010U);  // forward: 0 on the right, 1 on the left
    set_motor_direction(world, 0, kRight, 7);
    set_motor_direction(world, 0, kLeft, 0);
    EXPECT_EQ(motor_directions(world, 0), 0b001U);
}

TEST(Motors, CommandNothingBeforeTheyAreSetAndInObjectsWithoutWheels) {
    World world = testing::world_with_robot();
    drive(world, 0);
    EXPECT_FALSE(world.robots.command[0].pending);
    ObjectSpec pogobject = testing::pogobot_spec();
    pogobject.robot->model = head_model();
    world = testing::world_with_robot(pogobject);
    set_motor_power(world, 0, kLeft, kFullMotorPower);
    drive(world, 0);
    EXPECT_FALSE(world.robots.command[0].pending);
}

TEST(Motors, BiasesAreDrawnFromTheRobotsOwnStreamWithinTheirRange) {
    ObjectSpec spec = testing::pogobot_spec();
    spec.robot->motor_bias = {.min = -20, .max = 20};
    World world = testing::square_world();
    for (int i = 0; i < 100; ++i) {
        testing::add_robot(world, {10.0F * static_cast<float>(i), 500}, 0.0F, spec);
    }
    set_up_devices(world, 1);
    float sum = 0.0F;
    for (std::uint32_t robot = 0; robot < 100; ++robot) {
        float const bias = world.devices.motors[robot].bias;
        EXPECT_LE(std::abs(bias), 20.0F);
        EXPECT_EQ(bias, std::round(bias));
        sum += bias;
    }
    EXPECT_NEAR(sum / 100.0F, 0.0F, 4 * 1.18F);  // the deviation of the mean of 41 equal chances, over ten
    EXPECT_EQ(world.devices.motors[100].bias, 0.0F) << "of the global step";
}

}  // namespace
}  // namespace pogosim
