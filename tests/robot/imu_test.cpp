// What the inertial measurement unit tells a program.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "support/lone_robot.hpp"

namespace pogosim {
namespace {

using testing::full_ahead;
using testing::run_alone;

constexpr float kG = 9.80665F;    // m/s2
constexpr float kTickS = 0.016F;  // of a main loop of 60 Hz

struct Reading {
    std::array<float, 3> acceleration;  // m/s2: right, forward, up
    std::array<float, 3> gyro;          // rad/s
};

/// Readings of the lone robot, one per tick. The user data are cleared before each run, so this stands outside.
std::vector<Reading> readings;

void read_imu() {
    Reading now;
    // Nothing of these may survive.
    now.acceleration.fill(NAN);
    now.gyro.fill(NAN);
    pogobot_imu_read(now.acceleration.data(), now.gyro.data());
    readings.push_back(now);
}

std::vector<Reading> const& readings_of(ObjectSpec const& spec, void (*init)(), double seconds) {
    readings.clear();
    run_alone(spec, init, read_imu, seconds);
    return readings;
}

void left_alone() {
    pogobot_motor_set(motorL, motorFull);
}

void right_alone() {
    pogobot_motor_set(motorR, motorFull);
}

void both_backwards() {
    full_ahead();
    pogobot_motor_dir_set(motorL, 0);
    pogobot_motor_dir_set(motorR, 1);
}

TEST(Imu, GyroscopeCountsCounterClockwise) {
    EXPECT_NEAR(readings_of(testing::article_robot(), left_alone, 1.0).back().gyro[2], -4.0F, 1e-3F);
    EXPECT_NEAR(readings_of(testing::article_robot(), right_alone, 1.0).back().gyro[2], 4.0F, 1e-3F);
    EXPECT_EQ(readings_of(testing::article_robot(), full_ahead, 1.0).back().gyro[2], 0.0F);
    EXPECT_FALSE(std::signbit(readings.back().gyro[2]));  // would be printed as -0.00
    EXPECT_EQ(readings.back().gyro[0], 0.0F);
    EXPECT_EQ(readings.back().gyro[1], 0.0F);
}

TEST(Imu, GyroscopeShowsHowFastTheHeadingChanges) {
    ObjectSpec spec = testing::article_robot();
    spec.robot->angular_noise_stddev = 2.0F;
    testing::use_program(full_ahead, [] {
        main_loop_hz = 0;  // a tick at each step
        read_imu();
    });
    Simulation simulation(testing::test_program(),
                          testing::square_scene({testing::robot_at({2500, 2500}, spec)}, 5000.0), {});
    ASSERT_FALSE(simulation.start());
    readings.clear();
    for (int i = 0; i < 100; ++i) {
        float const before_rad = simulation.world().bodies.heading_rad[0];
        ASSERT_FALSE(simulation.step());
        float const turned_rad = simulation.world().bodies.heading_rad[0] - before_rad;
        ASSERT_FALSE(simulation.step());
        // Rates of 2 rad/s turn 20 mrad a step, headings are good to some microradians.
        EXPECT_NEAR(readings.back().gyro[2], -turned_rad / 0.01F, 1e-3F);
    }
}

TEST(Imu, GyroscopeEndsAt2000DegreesPerSecond) {
    ObjectSpec spec = testing::article_robot();
    spec.robot->max_angular_speed_rad_s = 30.0F;  // 60 rad/s with one motor
    EXPECT_NEAR(readings_of(spec, left_alone, 0.5).back().gyro[2], -34.9F, 0.01F);
    EXPECT_NEAR(readings_of(spec, right_alone, 0.5).back().gyro[2], 34.9F, 0.01F);
    spec.robot->max_angular_speed_rad_s = 17.0F;
    EXPECT_NEAR(readings_of(spec, left_alone, 0.5).back().gyro[2], -34.0F, 0.01F);
}

TEST(Imu, AccelerometerIsZeroBeforeTheFirstTickAndAtIt) {
    readings.clear();
    run_alone(
        testing::article_robot(),
        [] {
            full_ahead();
            read_imu();
        },
        read_imu, 0.01);
    ASSERT_EQ(readings.size(), 2U);
    for (Reading const& reading : readings) {
        EXPECT_EQ(reading.acceleration, (std::array<float, 3>{}));
    }
}

TEST(Imu, RobotThatStartsShowsItsSpeedOverTheTimeForwardAndThenNothing) {
    // 0.1 m/s within a tick of 16 ms; nothing to the side, and no gravity.
    for (auto const& [init, speed_m_s] : {std::pair{&full_ahead, 0.1F}, std::pair{&both_backwards, -0.1F}}) {
        std::vector<Reading> const& imu = readings_of(testing::article_robot(), init, 0.2);
        for (std::size_t tick = 0; tick < imu.size(); ++tick) {
            EXPECT_NEAR(imu[tick].acceleration[0], 0.0F, 1e-4F);
            EXPECT_NEAR(imu[tick].acceleration[1], tick == 1 ? speed_m_s / kTickS : 0.0F, 1e-3F);
            EXPECT_EQ(imu[tick].acceleration[2], 0.0F);
        }
    }
}

TEST(Imu, ForwardIsForwardWhateverTheHeading) {
    static std::vector<Reading> starts;
    starts.clear();
    testing::use_program(full_ahead, [] {
        if (pogobot_ticks == 1) {
            read_imu();
            starts.push_back(readings.back());
        }
    });
    Scenario scenario = testing::square_scene({testing::robots(49)}, 2000.0);
    scenario.formation.name = "chessboard";  // 100 mm apart, headings at random
    Simulation simulation(testing::test_program(), std::move(scenario), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 0.03));
    ASSERT_EQ(starts.size(), 49U);
    for (Reading const& start : starts) {
        EXPECT_NEAR(start.acceleration[0], 0.0F, 1e-3F);
        EXPECT_NEAR(start.acceleration[1], 0.1F / kTickS, 1e-3F);
    }
}

TEST(Imu, AccelerometerEndsAt16G) {
    ObjectSpec spec = testing::article_robot();
    spec.robot->max_linear_speed_mm_s = 4000.0F;  // 25 g to get there in a tick
    EXPECT_NEAR(readings_of(spec, full_ahead, 0.03)[1].acceleration[1], 16.0F * kG, 0.01F);
    EXPECT_NEAR(readings_of(spec, both_backwards, 0.03)[1].acceleration[1], -16.0F * kG, 0.01F);
    spec.robot->max_linear_speed_mm_s = 2500.0F;
    EXPECT_NEAR(readings_of(spec, full_ahead, 0.03)[1].acceleration[1], 2.5F / kTickS, 0.1F);
}

TEST(Imu, TurningRobotShowsTheCentripetalAcceleration) {
    // v omega = 0.05 m/s * 4 rad/s, towards the side that the robot turns to.
    for (auto const& [init, right_m_s2] : {std::pair{&left_alone, 0.2F}, std::pair{&right_alone, -0.2F}}) {
        Vec2 sum;
        std::vector<Reading> const& imu = readings_of(testing::article_robot(), init, 5.0);
        for (std::size_t tick = 3; tick < imu.size(); ++tick) {
            sum = sum + Vec2{imu[tick].acceleration[0], imu[tick].acceleration[1]};
        }
        float const count = static_cast<float>(imu.size() - 3);
        EXPECT_NEAR(sum.x / count, right_m_s2, 0.01F);
        // The velocity changes at ticks, the heading all the time: it has turned a bit further.
        EXPECT_NEAR(sum.y / count, 0.0F, 0.03F);
    }
}

TEST(Imu, CollisionWithAWallIsABackwardAcceleration) {
    static float hardest;
    hardest = 0.0F;
    testing::use_program(full_ahead, [] {
        read_imu();
        hardest = std::min(hardest, readings.back().acceleration[1]);
    });
    Simulation simulation(testing::test_program(), testing::square_scene({testing::robot_at({950, 500})}), {});
    ASSERT_FALSE(simulation.start());
    ASSERT_FALSE(testing::run_for(simulation, 0.2));
    EXPECT_EQ(hardest, 0.0F);  // not there yet: 23.5 mm at 100 mm/s
    ASSERT_FALSE(testing::run_for(simulation, 0.2));
    // From 0.1 m/s to a stop or, with restitution 0.5, to half of it backwards.
    EXPECT_LT(hardest, -0.9F * 0.1F / kTickS);
    EXPECT_GT(hardest, -1.6F * 0.1F / kTickS);
}

TEST(Imu, TemperatureIsTheArenasWithinTheChipsRange) {
    static float temperature = 0.0F;
    testing::use_program([] { temperature = pogobot_imu_readTemp(); }, nullptr);
    for (auto const& [arena, chip] : {std::pair{25.0, 25.0F}, std::pair{200.0, 85.0F}, std::pair{-90.0, -40.0F}}) {
        Scenario scenario = testing::square_scene({testing::robots(1)});
        scenario.arena_temperature_c = arena;
        Simulation simulation(testing::test_program(), std::move(scenario), {});
        ASSERT_FALSE(simulation.start());
        EXPECT_FLOAT_EQ(temperature, chip);
    }
}

TEST(Imu, ArenaIsAt42DegreesUnlessTheConfigurationSaysOtherwise) {
    static float temperature = 0.0F;
    run_alone(
        testing::article_robot(), [] { temperature = pogobot_imu_readTemp(); }, nullptr, 0.0);
    EXPECT_EQ(temperature, 42.0F);
}

}  // namespace
}  // namespace pogosim
