// How a robot moves at what its program says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "support/lone_robot.hpp"

namespace pogosim {
namespace {

using testing::full_ahead;
using testing::run_alone;

TEST(Motion, RobotAt100MmPerSecondIsOneMetreAwayAfterTenSeconds) {
    auto const simulation = run_alone(testing::article_robot(), full_ahead, nullptr, 10.0);
    EXPECT_NEAR(simulation->world().bodies.position_mm[0].x, 3500.0F, 0.5F);
    EXPECT_NEAR(simulation->world().bodies.position_mm[0].y, 2500.0F, 0.1F);
}

TEST(Motion, PowersBeyondFullAreFull) {
    static uint16_t power = 0;
    auto const drive = [] {
        pogobot_motor_set(motorL, power);
        pogobot_motor_set(motorR, power);
    };
    for (auto const& [set, speed_mm_s] : {std::pair<uint16_t, float>{1022, 100.0F * 1022.0F / 1023.0F},
                                          {1023, 100.0F},
                                          {1024, 100.0F},
                                          {5000, 100.0F},
                                          {65535, 100.0F}}) {
        power = set;
        auto const simulation = run_alone(testing::article_robot(), drive, nullptr, 1.0);
        EXPECT_NEAR(simulation->world().bodies.position_mm[0].x, 2500.0F + speed_mm_s, 0.05F) << set;
    }
}

TEST(Motion, PowerSetOnceDrivesAgainstDampingUntilItIsChanged) {
    ObjectSpec spec = testing::article_robot();
    spec.body->linear_damping = 0.3F;
    auto const simulation = run_alone(spec, full_ahead, nullptr, 10.0);
    // Between two control ticks, 16 ms apart, damping takes half a percent at most.
    EXPECT_NEAR(simulation->world().bodies.position_mm[0].x, 3500.0F, 5.0F);
}

TEST(Motion, OneMotorAloneTurnsAtTwiceTheMaximalAngularSpeed) {
    auto const left_alone = run_alone(
        testing::article_robot(), [] { pogobot_motor_set(motorL, motorFull); }, nullptr, 5.0);
    EXPECT_NEAR(left_alone->world().bodies.heading_rad[0], wrap_angle(4.0F * 5.0F), 0.01F);
    EXPECT_NEAR(length(left_alone->world().bodies.velocity_mm_s[0]), 50.0F, 0.1F);
    auto const right_alone = run_alone(
        testing::article_robot(), [] { pogobot_motor_set(motorR, motorFull); }, nullptr, 5.0);
    EXPECT_NEAR(right_alone->world().bodies.heading_rad[0], wrap_angle(-4.0F * 5.0F), 0.01F);
}

TEST(Motion, TurningRobotRunsACircleOfRadiusSpeedOverTurnRate) {
    // Half the speed, 50 mm/s, at 4 rad/s: 12.5 mm. One turn takes pi / 2 s.
    testing::use_program([] { pogobot_motor_set(motorL, motorFull); }, nullptr);
    Simulation simulation(testing::test_program(), testing::square_scene({testing::robot_at({2500, 2500})}, 5000.0),
                          {});
    ASSERT_FALSE(simulation.start());
    Vec2 low{5000, 5000};
    Vec2 high{0, 0};
    for (int i = 0; i < 200; ++i) {
        ASSERT_FALSE(testing::run_for(simulation, 0.01));
        Vec2 const p = simulation.world().bodies.position_mm[0];
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    // The velocity keeps its direction for a control tick of 16 ms, so the path is a polygon around the circle.
    EXPECT_NEAR((high.x - low.x) / 2.0F, 12.5F, 0.3F);
    EXPECT_NEAR((high.y - low.y) / 2.0F, 12.5F, 0.3F);
}

TEST(Motion, BothDirectionBitsFlippedDriveBackwards) {
    auto const init = [] {
        uint8_t direction[3];
        pogobot_motor_dir_mem_get(direction);
        full_ahead();
        pogobot_motor_dir_set(motorL, direction[1] ^ 1);
        pogobot_motor_dir_set(motorR, direction[0] ^ 1);
    };
    auto const simulation = run_alone(testing::article_robot(), init, nullptr, 2.0);
    EXPECT_NEAR(simulation->world().bodies.position_mm[0].x, 2300.0F, 0.5F);
}

TEST(Motion, StoppedRobotStopsAtOnce) {
    auto const step = [] {
        uint16_t const power = pogobot_ticks < 60 ? motorFull : motorStop;
        pogobot_motor_set(motorL, power);
        pogobot_motor_set(motorR, power);
    };
    auto const simulation = run_alone(testing::article_robot(), nullptr, step, 3.0);
    EXPECT_NEAR(simulation->world().bodies.position_mm[0].x, 2500.0F + 100.0F * 60.0F * 0.016F, 2.0F);
    EXPECT_EQ(simulation->world().bodies.velocity_mm_s[0], Vec2{});
}

TEST(Motion, MotorBiasTurnsARobotThatDrivesStraight) {
    ObjectSpec spec = testing::article_robot();
    spec.robot->motor_bias = {50, 50};
    auto const simulation = run_alone(spec, full_ahead, nullptr, 2.0);
    EXPECT_NEAR(simulation->world().bodies.angular_velocity_rad_s[0], 2.0F * 100.0F / 511.5F, 1e-3F);
}

TEST(Motion, AngularNoiseOfStddevSSpreadsHeadingsAsARandomWalk) {
    ObjectSpec spec = testing::article_robot();
    spec.robot->angular_noise_stddev = 1.0F;
    testing::use_program([] { pogobot_motor_set(motorL, motorStop); }, nullptr);
    Scenario scenario = testing::square_scene({testing::robots(400, spec)}, 6000.0);
    Simulation simulation(testing::test_program(), std::move(scenario), {});
    ASSERT_FALSE(simulation.start());
    std::vector<float> const start = simulation.world().bodies.heading_rad;
    ASSERT_FALSE(testing::run_for(simulation, 4.0));
    double squares = 0.0;
    for (std::size_t i = 0; i < start.size(); ++i) {
        float const turned_rad = wrap_angle(simulation.world().bodies.heading_rad[i] - start[i]);
        squares += std::pow(turned_rad, 2) / static_cast<double>(start.size());
    }
    // A new turn rate of standard deviation 1 every 16 ms for 250 ticks: variance 250 * 0.016^2. Ticks fall on steps of
    // 10 ms, so a rate lasts 10 or 20 ms, whose mean square is (3 * 20^2 + 2 * 10^2) / 5 = 280 instead of 256.
    double const expected = 250.0 * 280e-6;
    EXPECT_NEAR(squares, expected, 4.0 * expected * std::sqrt(2.0 / 400.0));
}

TEST(Motion, LinearNoiseIsInUnitsOf100MmPerSecond) {
    ObjectSpec spec = testing::article_robot();
    spec.robot->linear_noise_stddev = 0.1F;
    testing::use_program([] { pogobot_motor_set(motorL, motorStop); }, nullptr);
    Simulation simulation(testing::test_program(), testing::square_scene({testing::robots(400, spec)}, 6000.0), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 0.01));
    double squares = 0.0;
    for (Vec2 const velocity : simulation.world().bodies.velocity_mm_s) {
        squares += static_cast<double>(squared_length(velocity)) / 800.0;
    }
    EXPECT_NEAR(squares, 100.0, 4.0 * 100.0 * std::sqrt(2.0 / 800.0));
}

}  // namespace
}  // namespace pogosim
