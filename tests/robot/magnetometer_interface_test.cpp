// What the magnetometer tells a program.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "device/magnetometer.hpp"
#include "support/lone_robot.hpp"
#include "support/objects.hpp"

extern "C" std::uint8_t magn_check();

namespace pogosim {
namespace {

struct Read {
    int status = -1;
    std::array<std::int16_t, 3> counts{};
    std::int64_t time_us = 0;
};

/// The reads of all robots, in the order of the calls.
std::vector<Read> reads;
uint16_t timeout_ms = 20;

Read read_now() {
    Read now;
    now.status = magn_read_XYZ(&now.counts[0], &now.counts[1], &now.counts[2], timeout_ms);
    now.time_us = current_time_milliseconds() * 1000;
    return now;
}

void read_once() {
    Read const now = read_now();
    reads.push_back(now);
}

Scenario lone_robot_scene(ObjectSpec const& spec = testing::article_robot()) {
    return testing::square_scene({testing::robot_at({2500, 2500}, spec)}, 5000.0);
}

/// Simulations of one robot; the world may be changed before the start.
template <class Change>
std::vector<Read> reads_of(Change change, double seconds) {
    reads.clear();
    testing::use_program([] {}, read_once);
    Simulation simulation(testing::test_program(), lone_robot_scene(), {});
    change(const_cast<World&>(simulation.world()));
    EXPECT_FALSE(simulation.start());
    EXPECT_FALSE(testing::run_for(simulation, seconds));
    return reads;
}

TEST(MagnetometerInterface, ReadSucceedsWithZeroAndDiffersFromSampleToSample) {
    std::vector<Read> const found = reads_of([](World&) {}, 1.0);
    ASSERT_GT(found.size(), 50U);
    bool differ = false;
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].status, 0);
        EXPECT_NEAR(found[i].counts[0], 597.0, 20.0);
        EXPECT_NEAR(found[i].counts[1], 419.0, 20.0);
        differ = differ || found[i].counts != found[0].counts;
    }
    EXPECT_TRUE(differ);
}

TEST(MagnetometerInterface, EachReadIsTheModelAtTheTrueHeading) {
    testing::use_program([] { pogobot_motor_set(motorL, motorHalf); },
                         [] {
                             main_loop_hz = 0;  // a tick at each step
                             read_once();
                         });
    Simulation simulation(testing::test_program(), lone_robot_scene(), {});
    ASSERT_FALSE(simulation.start());
    reads.clear();
    World const& world = simulation.world();
    for (std::uint64_t i = 0; i < 50; ++i) {
        Pose const pose{.position_mm = world.bodies.position_mm[0], .heading_rad = world.bodies.heading_rad[0]};
        ASSERT_FALSE(simulation.step());
        ASSERT_EQ(reads.size(), i + 1);
        EXPECT_EQ(reads.back().counts, measure_field(world.magnetometer, 0, i, pose));
    }
    EXPECT_GT(std::abs(world.bodies.heading_rad[0]), 0.5F);
}

TEST(MagnetometerInterface, ReadBeyondTheSeamIsThatOfThePlaceInTheArena) {
    testing::use_program([] {}, read_once);
    Scenario scenario = lone_robot_scene();
    scenario.boundary = BoundaryCondition::periodic;
    scenario.magnetometer.spec.field.gradient_x = {0.001, 0.0, 0.0};
    Simulation simulation(testing::test_program(), scenario, {});
    ASSERT_FALSE(simulation.start());
    reads.clear();
    auto& world = const_cast<World&>(simulation.world());
    Pose const pose{.position_mm = world.bodies.position_mm[0], .heading_rad = world.bodies.heading_rad[0]};
    world.bodies.position_mm[0].x += 5000.0F;  // as that of a robot in a membrane that lies on the seam
    ASSERT_FALSE(simulation.step());
    ASSERT_EQ(reads.size(), 1U);
    EXPECT_EQ(reads[0].counts, measure_field(world.magnetometer, 0, 0, pose));
}

TEST(MagnetometerInterface, OnARobotDataAreNewFiftyTimesPerSecond) {
    timeout_ms = 25;
    std::vector<Read> const found =
        reads_of([](World& world) { world.magnetometer.timing = MagnetometerTiming::robot; }, 2.0);
    timeout_ms = 20;
    ASSERT_GT(found.size(), 10U);
    std::int64_t last = 0;
    for (Read const& read : found) {
        EXPECT_EQ(read.status, 0);
        EXPECT_GT(read.time_us / 20000, last);  // never the same data twice
        last = read.time_us / 20000;
    }
    EXPECT_GE(last, static_cast<std::int64_t>(found.size()));
}

TEST(MagnetometerInterface, OnARobotAShortTimeoutEndsWithoutData) {
    timeout_ms = 1;
    std::vector<Read> const found =
        reads_of([](World& world) { world.magnetometer.timing = MagnetometerTiming::robot; }, 1.0);
    timeout_ms = 20;
    auto const failures = std::ranges::count(found, 1, &Read::status);
    EXPECT_GT(failures, 0);  // ticks of 16 ms, data every 20 ms
    EXPECT_GT(static_cast<std::size_t>(failures), found.size() / 10);
    EXPECT_LT(static_cast<std::size_t>(failures), found.size() / 2);
    for (Read const& read : found) {
        EXPECT_EQ(read.counts == (std::array<std::int16_t, 3>{}), read.status == 1);  // untouched
    }
}

TEST(MagnetometerInterface, OnARobotTimeoutZeroLooksForNothing) {
    timeout_ms = 0;
    std::vector<Read> const on_robot =
        reads_of([](World& world) { world.magnetometer.timing = MagnetometerTiming::robot; }, 0.5);
    std::vector<Read> const at_once = reads_of([](World&) {}, 0.5);
    timeout_ms = 20;
    EXPECT_EQ(std::ranges::count(on_robot, 1, &Read::status), std::ssize(on_robot));
    EXPECT_EQ(std::ranges::count(at_once, 0, &Read::status), std::ssize(at_once));
}

struct Found {
    int init = -1;
    int check = -1;
    int read = -1;
};
Found found;

void look_for_it() {
    std::int16_t x = 77;
    found = {.init = magn_init(), .check = magn_check(), .read = magn_read_XYZ(&x, &x, &x, 20)};
    EXPECT_TRUE(found.read == 0 || x == 77);
}

Found found_by(ObjectSpec const& spec) {
    testing::use_program([] {}, look_for_it);
    Simulation simulation(testing::test_program(), lone_robot_scene(spec), {});
    found = {};
    EXPECT_FALSE(simulation.start());
    EXPECT_FALSE(testing::run_for(simulation, 0.1));
    return found;
}

TEST(MagnetometerInterface, ObjectWithoutMagnetometerFindsNone) {
    Found const robot = found_by(testing::article_robot());
    EXPECT_EQ(robot.init, 1);
    EXPECT_EQ(robot.check, 0);
    EXPECT_EQ(robot.read, 0);
    ObjectSpec disabled = testing::article_robot();
    disabled.robot->magnetometer_enabled = false;
    ObjectSpec without = testing::article_robot();
    without.robot->model.has_magnetometer = false;
    for (ObjectSpec const& spec : {disabled, without}) {
        Found const none = found_by(spec);
        EXPECT_EQ(none.init, 0);
        EXPECT_EQ(none.check, 1);
        EXPECT_EQ(none.read, 1);
    }
}

TEST(MagnetometerInterface, NullPointerReadsNothing) {
    testing::use_program([] {},
                         [] {
                             std::int16_t x = 77;
                             std::int16_t y = 78;
                             EXPECT_EQ(magn_read_XYZ(&x, &y, nullptr, 20), 1);
                             EXPECT_EQ(x, 77);
                             EXPECT_EQ(y, 78);
                             mydata->number[0] = 1;
                         });
    Simulation simulation(testing::test_program(), lone_robot_scene(), {});
    ASSERT_FALSE(simulation.start());
    EXPECT_FALSE(testing::run_for(simulation, 0.1));
    EXPECT_EQ(reinterpret_cast<TestData const*>(simulation.controllers().controller_of(0).user_data)->number[0], 1);
}

TEST(MagnetometerInterface, InspectorAndHashKnowWhatWasReadLast) {
    testing::use_program([] {}, read_once);
    Simulation simulation(testing::test_program(), lone_robot_scene(), {});
    ASSERT_FALSE(simulation.start());
    EXPECT_EQ(simulation.inspector().inspect(0).magnetometer_samples, 0U);
    reads.clear();
    EXPECT_FALSE(testing::run_for(simulation, 0.5));
    Inspection const inspection = simulation.inspector().inspect(0);
    EXPECT_EQ(inspection.magnetometer_samples, reads.size());
    EXPECT_TRUE(std::ranges::equal(inspection.magnetometer, reads.back().counts));

    testing::use_program([] {}, [] {});
    Simulation other(testing::test_program(), lone_robot_scene(), {});
    ASSERT_FALSE(other.start());
    EXPECT_FALSE(testing::run_for(other, 0.5));
    EXPECT_NE(simulation.hash(), other.hash());
}

TEST(MagnetometerInterface, PoseOutsideTheDomainEndsTheRunIfItsPolicyIsToThrow) {
    testing::use_program([] {}, read_once);
    Simulation simulation(testing::test_program(), lone_robot_scene(), {});
    MagneticDomain& domain = const_cast<World&>(simulation.world()).magnetometer.domain;
    domain.x_mm = Interval{0.0, 2000.0};
    domain.policy = DomainPolicy::refuse;
    ASSERT_FALSE(simulation.start());
    auto const failure = testing::run_for(simulation, 0.1);
    ASSERT_TRUE(failure);
    EXPECT_EQ(failure->code, ExitCode::usage);
    EXPECT_NE(failure->what.find("x 2500.0 mm, y 2500.0 mm, heading 0.0 degrees is outside magnetometer.domain"),
              std::string::npos)
        << failure->what;
}

TEST(MagnetometerInterface, ReadingChangesNoOtherRandomNumbers) {
    ObjectSpec spec = testing::article_robot();
    spec.robot->linear_noise_stddev = 0.3F;
    spec.robot->photosensor_noise_stddev = 3.0F;
    auto const end_of = [&](void (*step)()) {
        auto const simulation = testing::run_alone(spec, testing::full_ahead, step, 1.0);
        return simulation->world().bodies.position_mm[0];
    };
    EXPECT_EQ(end_of([] {}), end_of(read_once));
}

}  // namespace
}  // namespace pogosim
