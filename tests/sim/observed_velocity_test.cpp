// Every observer of a robot is told what its body really does: the inspector, hosts, the supervisor and the robot's own
// sensors. With both engines.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "pogosim/world.h"
#include "support/objects.hpp"
#include "support/scenes.hpp"
#include "support/test_program.hpp"

namespace pogosim {
namespace {

using namespace testing;

constexpr float kSpeed = 100.0F;  // mm/s, of robots at full power
constexpr float kPi = std::numbers::pi_v<float>;

void full_ahead() {
    pogobot_motor_set(motorL, motorFull);
    pogobot_motor_set(motorR, motorFull);
}

/// Accelerations that robot 0 felt, m/s2 forward, one a tick.
std::vector<float> felt;  // NOLINT
/// What it was told of its own turning, rad/s.
float gyroscope = 0.0F;
pogosim_velocity_t seen_by_supervisor = {};

void drive_and_feel() {
    full_ahead();
    float acceleration[3];
    float gyro[3];
    pogobot_imu_read(acceleration, gyro);
    if (pogobot_helper_getid() == 0) {
        felt.push_back(acceleration[1]);
        gyroscope = gyro[2];
    }
}

class ObservedVelocity : public ::testing::TestWithParam<std::string> {
protected:
    void SetUp() override {
        felt.clear();
        program_main = [] {
            pogobot_init();
            pogobot_start(full_ahead, drive_and_feel, "robots");
            callback_global_step = [] { pogosim_world_velocity(0, &seen_by_supervisor); };
        };
    }

    Simulation& start(std::vector<ObjectConfig> objects, double time_step_s = 0.01) {
        Scenario scenario = square_scene(std::move(objects));
        scenario.physics_engine = GetParam();
        scenario.time_step_s = time_step_s;
        scenario.walls = walls_;
        simulation_ = std::make_unique<Simulation>(test_program(), std::move(scenario), RunOptions{});
        simulation_->inspector();
        EXPECT_FALSE(simulation_->start());
        return *simulation_;
    }

    void run(double seconds) {
        double const end_s = simulation_->world().time_s() + seconds - 1e-9;
        while (simulation_->world().time_s() < end_s) {
            ASSERT_FALSE(simulation_->step());
            simulation_->inspector().note_step();
        }
    }

    /// All observers agree, but for what the supervisor sees one step later.
    void expect_velocity(Vec2 velocity_mm_s, float tolerance) {
        EXPECT_NEAR(simulation_->inspector().inspect(0).speed_mm_s, length(velocity_mm_s), tolerance);
        EXPECT_NEAR(simulation_->observed_motions().velocity_mm_s()[0].x, velocity_mm_s.x, tolerance);
        EXPECT_NEAR(simulation_->observed_motions().velocity_mm_s()[0].y, velocity_mm_s.y, tolerance);
        EXPECT_NEAR(seen_by_supervisor.x_mm_s, velocity_mm_s.x, tolerance);
        EXPECT_NEAR(seen_by_supervisor.y_mm_s, velocity_mm_s.y, tolerance);
    }

    WallSpec walls_{.friction = 0.0F, .restitution = 0.0F};
    std::unique_ptr<Simulation> simulation_;
};

INSTANTIATE_TEST_SUITE_P(Engine, ObservedVelocity, ::testing::Values("box2d", "disk"),
                         [](::testing::TestParamInfo<std::string> const& info) { return info.param; });

/// A robot that does not bounce.
ObjectConfig heading(float heading_rad, Vec2 position_mm) {
    ObjectConfig robot = robot_at(position_mm);
    robot.spec.body->restitution = 0.0F;
    robot.spec.body->friction = 0.0F;
    robot.heading_rad = heading_rad;
    return robot;
}

TEST_P(ObservedVelocity, RobotOnFreeGroundHasThatOfItsMotors) {
    start({heading(0.0F, {300, 500})});
    run(1.0);
    expect_velocity({kSpeed, 0}, 1e-3F);
    Inspection const robot = simulation_->inspector().inspect(0);
    EXPECT_NEAR(robot.moved_mm, kSpeed, 0.05F);
    EXPECT_NEAR(robot.moved_during_s, 1.0, 1e-9);
    EXPECT_TRUE(robot.touches.empty());
}

TEST_P(ObservedVelocity, RobotPressedAgainstAWallStands) {
    start({heading(0.0F, {900, 500})});
    run(3.0);
    expect_velocity({}, 0.01F);
    Inspection const robot = simulation_->inspector().inspect(0);
    EXPECT_NEAR(robot.moved_mm, 0.0F, 0.1F);
    EXPECT_EQ(robot.touches, std::vector<std::string>{"wall"});
    EXPECT_NEAR(felt.back(), 0.0F, 1e-3F);
    EXPECT_NEAR(gyroscope, 0.0F, 1e-3F);
}

TEST_P(ObservedVelocity, RobotThatBouncesAtAWallIsToldWhatItsBodyDoesAndHasNoSpeedOverAWhile) {
    walls_.restitution = 0.5F;
    start({heading(0.0F, {900, 500})});
    run(3.0);
    Vec2 const place_mm = simulation_->world().bodies.position_mm[0];
    ASSERT_FALSE(simulation_->step());
    Vec2 const moved_mm = simulation_->world().bodies.position_mm[0] - place_mm;
    EXPECT_NEAR(simulation_->observed_motions().velocity_mm_s()[0].x, moved_mm.x / 0.01F, 0.1F);
    for (int i = 0; i < 50; ++i) {
        run(0.01);
        Inspection const robot = simulation_->inspector().inspect(0);
        EXPECT_LT(robot.speed_mm_s, 12.0F);
        EXPECT_LT(robot.moved_mm, 1.5F);
        EXPECT_EQ(robot.touches, std::vector<std::string>{"wall"});
    }
}

TEST_P(ObservedVelocity, RobotThatSlidesAlongAWallHasItsTangentialSpeed) {
    start({heading(kPi / 6.0F, {100, 970})});  // 30 degrees towards the wall at y = 1000
    run(3.0);
    expect_velocity({kSpeed * std::cos(kPi / 6.0F), 0}, 0.2F);
    EXPECT_NEAR(simulation_->inspector().inspect(0).moved_mm, kSpeed * std::cos(kPi / 6.0F), 0.2F);
    EXPECT_EQ(simulation_->inspector().inspect(0).touches, std::vector<std::string>{"wall"});
}

TEST_P(ObservedVelocity, RobotsThatPushEachOtherStand) {
    start({heading(0.0F, {450, 500}), heading(kPi, {550, 500})});
    run(2.0);
    expect_velocity({}, 0.05F);
    EXPECT_EQ(simulation_->inspector().inspect(0).touches, std::vector<std::string>{"robot 1"});
    EXPECT_EQ(simulation_->inspector().inspect(1).touches, std::vector<std::string>{"robot 0"});
}

TEST_P(ObservedVelocity, RobotInACornerTouchesTheWallAndTheRobotBehindIt) {
    start({heading(0.0F, {950, 500}), heading(0.0F, {890, 500})});
    run(2.0);
    EXPECT_EQ(simulation_->inspector().inspect(0).touches, (std::vector<std::string>{"wall", "robot 1"}));
    EXPECT_EQ(simulation_->inspector().inspect(1).touches, std::vector<std::string>{"robot 0"});
    expect_velocity({}, 0.05F);
}

TEST_P(ObservedVelocity, ObjectsOfOtherCategoriesAreTouchedByName) {
    ObjectConfig puck = at(passive_object({.kind = ShapeKind::disk, .radius_mm = 40.0F}, "pucks"), {960, 500});
    start({heading(0.0F, {890, 500}), puck});
    run(2.0);
    auto const touches = simulation_->inspector().inspect(0).touches;
    ASSERT_EQ(touches.size(), 1U);
    EXPECT_EQ(touches[0].substr(0, 6), "pucks ");
}

TEST_P(ObservedVelocity, RobotThatIsStoppedByAWallFeelsTheLossOfItsSpeedOnce) {
    start({heading(0.0F, {900, 500})}, 0.016);  // each tick is a step
    run(2.0);
    double sum_m_s = 0.0;
    for (float const acceleration : felt) {
        sum_m_s += 0.016 * static_cast<double>(acceleration);
    }
    // It started with 0.1 m/s, lost them, and stands.
    EXPECT_NEAR(sum_m_s, 0.0, 1e-4);
    EXPECT_NEAR(felt.at(1), 0.1F / 0.016F, 0.01F);
    float strongest = 0.0F;
    for (float const acceleration : felt) {
        strongest = std::min(strongest, acceleration);
    }
    EXPECT_LE(strongest, -0.45F * 0.1F / 0.016F);  // within two ticks
    EXPECT_GE(strongest, -1.001F * 0.1F / 0.016F);
}

TEST_P(ObservedVelocity, SumOfAllStepsIsTheWholeWay) {
    start({heading(0.4F, {500, 500}), heading(2.0F, {700, 500}), heading(3.0F, {800, 540})});
    std::vector<Vec2> way(3);
    std::vector<Vec2> const places = simulation_->world().bodies.position_mm;
    for (int i = 0; i < 800; ++i) {
        ASSERT_FALSE(simulation_->step());
        for (std::size_t robot = 0; robot < way.size(); ++robot) {
            way[robot] = way[robot] + 0.01F * simulation_->observed_motions().velocity_mm_s()[robot];
        }
    }
    for (std::size_t robot = 0; robot < way.size(); ++robot) {
        Vec2 const expected = simulation_->world().bodies.position_mm[robot] - places[robot];
        EXPECT_NEAR(way[robot].x, expected.x, 0.5F) << robot;
        EXPECT_NEAR(way[robot].y, expected.y, 0.5F) << robot;
    }
}

TEST_P(ObservedVelocity, RobotThatIsPutElsewhereHasNotMoved) {
    start({heading(0.0F, {300, 500})});
    run(0.5);
    expect_velocity({kSpeed, 0}, 1e-3F);
    ASSERT_TRUE(simulation_->set_pose(0, {700, 300}, 1.0F));
    EXPECT_EQ(simulation_->observed_motions().velocity_mm_s()[0], Vec2{});
    run(0.5);
    EXPECT_NEAR(simulation_->inspector().inspect(0).moved_mm, length(Vec2{50, 0} + 50.0F * direction(1.0F)), 2.5F);
}

TEST_P(ObservedVelocity, RobotThatStopsHasNoneFromTheNextStepOn) {
    start({heading(0.0F, {300, 500})});
    run(0.5);
    simulation_->set_alive(0, false);
    run(0.2);
    expect_velocity({}, 0.0F);
    EXPECT_EQ(simulation_->world().bodies.start_mm[0], simulation_->world().bodies.position_mm[0]);
}

}  // namespace
}  // namespace pogosim
