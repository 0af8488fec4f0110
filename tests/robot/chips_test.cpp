// What programs read of the chips of their robots.
#include "device/chips.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "support/lone_robot.hpp"

namespace pogosim {
namespace {

using testing::full_ahead;
using testing::run_alone;

std::vector<float> forward;  // acceleration, one for each tick

void read_forward() {
    std::array<float, 3> acceleration{};
    std::array<float, 3> gyro{};
    pogobot_imu_read(acceleration.data(), gyro.data());
    forward.push_back(acceleration[1]);
}

/// Largest forward acceleration that a robot reads when it starts from rest to 100 mm/s within a step.
float largest_at_start(SensorSpec const& sensors) {
    ObjectSpec spec = testing::article_robot();
    spec.robot->sensors = sensors;
    forward.clear();
    run_alone(
        spec, [] { main_loop_hz = 0; },
        [] {
            if (pogobot_ticks == 3) {
                full_ahead();
            }
            read_forward();
        },
        0.2);
    EXPECT_EQ(forward.front(), 0.0F);
    EXPECT_EQ(forward.back(), 0.0F);
    return *std::ranges::max_element(forward);
}

TEST(Chips, StartWithinAStepOf10MsIs10MetresOr100DecimetresPerSecondSquared) {
    EXPECT_NEAR(largest_at_start({}), 10.0F, 0.01F);
    EXPECT_NEAR(largest_at_start({.acceleration = ImuAcceleration::original}), 100.0F, 0.1F);
}

TEST(Chips, OriginalAccelerationIsThatOfTheLastPhysicsStepOnly) {
    ObjectSpec spec = testing::article_robot();
    spec.robot->sensors.acceleration = ImuAcceleration::original;
    forward.clear();
    // Ticks are 50 ms apart: the step in which the robot starts is over when it reads next.
    run_alone(
        spec, [] { main_loop_hz = 20; },
        [] {
            full_ahead();
            read_forward();
        },
        0.5);
    ASSERT_GT(forward.size(), 5U);
    for (float const value : forward) {
        EXPECT_EQ(value, 0.0F);
    }
}

TEST(Chips, NoiseOfTheInertialUnitChangesNothingElse) {
    ObjectSpec spec = testing::article_robot();
    spec.robot->linear_noise_stddev = 0.3F;
    auto const place_after = [&spec] {
        forward.clear();
        return run_alone(spec, full_ahead, read_forward, 1.0)->world().bodies.position_mm[0];
    };
    Vec2 const without = place_after();
    std::vector<float> const exact = forward;
    spec.robot->sensors.acceleration_noise_m_s2 = 0.1F;
    EXPECT_EQ(place_after(), without);
    EXPECT_NE(forward, exact);
}

TEST(Chips, ModelOfARobotReadsGravityAndItsNoise) {
    ObjectSpec spec = testing::article_robot();
    spec.robot->sensors = kRobotSensors;
    static std::vector<float> upwards;
    upwards.clear();
    run_alone(
        spec, [] {},
        [] {
            std::array<float, 3> acceleration{};
            std::array<float, 3> gyro{};
            pogobot_imu_read(acceleration.data(), gyro.data());
            upwards.push_back(acceleration[2]);
        },
        5.0);
    double sum = 0.0;
    for (float const value : upwards) {
        sum += value;
        EXPECT_NEAR(std::remainder(value, kAccelerationStep), 0.0F, 2e-6F);
    }
    EXPECT_NEAR(sum / static_cast<double>(upwards.size()), kGravity, 0.005);
    EXPECT_NE(upwards.front(), upwards.back());
}

}  // namespace
}  // namespace pogosim
