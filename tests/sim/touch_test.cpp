// What a user does to a run in the window: clicks, and objects moved by hand.
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "record/scratch.hpp"
#include "sim/touches.hpp"
#include "support/objects.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_program.hpp"

namespace pogosim {
namespace {

using namespace testing;

constexpr float kRadius = 26.5F;

void idle() {}

void full_ahead() {
    pogobot_motor_set(motorL, motorFull);
    pogobot_motor_set(motorR, motorFull);
}

void start(Simulation& simulation) {
    ASSERT_FALSE(simulation.start());
}

Scenario recorded(Scenario scenario, std::string const& path) {
    scenario.output.enable_data_logging = true;
    scenario.output.data_filename = path;
    scenario.output.save_data_period_s = 0.1;
    return scenario;
}

/// The metadata entry of a data file.
std::optional<std::string> touched(std::string const& path) {
    auto const value = read_back(path).table->schema()->metadata()->Get("touched");
    return value.ok() ? std::optional(*value) : std::nullopt;
}

void expect_at(Vec2 place, Vec2 expected, float tolerance_mm = 0.05F) {
    EXPECT_NEAR(place.x, expected.x, tolerance_mm);
    EXPECT_NEAR(place.y, expected.y, tolerance_mm);
}

TEST(MoveByHand, RobotGoesOnDrivingFromTheNewPlace) {
    TemporaryFolder const folder;
    use_program(idle, full_ahead);
    Simulation simulation(testing::test_program(), recorded(square_scene({robot_at({200, 200})}), folder / "a.feather"),
                          {});
    start(simulation);
    ASSERT_FALSE(run_for(simulation, 0.5));
    EXPECT_TRUE(simulation.move_object(0, {300, 700}));
    expect_at(simulation.world().bodies.position_mm[0], {300, 700});
    EXPECT_EQ(simulation.world().bodies.velocity_mm_s[0], Vec2{});
    ASSERT_FALSE(run_for(simulation, 1.0));
    simulation.finish();
    Vec2 const place = simulation.world().bodies.position_mm[0];
    EXPECT_NEAR(place.x, 400, 3);
    EXPECT_NEAR(place.y, 700, 0.1F);
    ReadBack const data = read_back(folder / "a.feather");
    ASSERT_EQ(data.table->num_rows(), 16);
    EXPECT_NEAR(std::stof(data.text("y", 5)), 200, 0.1F);
    EXPECT_NEAR(std::stof(data.text("y", 6)), 700, 0.1F);
    EXPECT_EQ(touched(folder / "a.feather"), "once, at t = 0.5000 s: objects moved by hand");
}

TEST(MoveByHand, RobotPushedAgainstAWallStaysInside) {
    use_program(idle, full_ahead);
    Simulation simulation(testing::test_program(), square_scene({robot_at({500, 500})}), {});
    start(simulation);
    for (int i = 0; i < 100; ++i) {
        simulation.move_object(0, {1200, 500.0F + static_cast<float>(i)});
        ASSERT_FALSE(simulation.step());
        Vec2 const place = simulation.world().bodies.position_mm[0];
        ASSERT_TRUE(simulation.world().arena.contains(place));
        ASSERT_NEAR(place.x, 1000 - kRadius, 2.0F);
        ASSERT_NEAR(place.y, 500 + i, 2.0F);
    }
}

TEST(MoveByHand, RobotDroppedOnAnotherSeparatesFromIt) {
    use_program(idle, idle);
    Simulation simulation(testing::test_program(), square_scene({robot_at({200, 200}), robot_at({500, 500})}), {});
    start(simulation);
    ASSERT_FALSE(run_for(simulation, 1.0));
    EXPECT_TRUE(simulation.move_object(0, {500, 500}));
    ASSERT_FALSE(run_for(simulation, 1.0));
    auto const& places = simulation.world().bodies.position_mm;
    EXPECT_GT(length(places[1] - places[0]), 2.0F * kRadius - 1.0F);
}

TEST(MoveByHand, MembraneMovesAsItIsAndRobotsStayWhereTheyAre) {
    program_main = [] {
        pogobot_init();
        pogobot_start(idle, idle, "robots");
        pogobot_start(idle, idle, "membranes");
    };
    Simulation simulation(
        testing::test_program(),
        square_scene({robot_at({400, 400}), at(membrane(), {400, 400}), robot_at({1500, 1500})}, 2000.0), {});
    start(simulation);
    ASSERT_FALSE(run_for(simulation, 1.0));
    std::vector<Vec2> const before = simulation.world().bodies.position_mm;
    EXPECT_TRUE(simulation.move_object(1, {1500, 1500}));
    std::vector<Vec2> const after = simulation.world().bodies.position_mm;
    Vec2 const motion = after[1] - before[1];
    for (std::size_t i = 1; i + 1 < after.size(); ++i) {
        expect_at(after[i] - before[i], motion, 0.01F);
    }
    // Robot 0 is outside now, robot 1 inside, and both remain there.
    ASSERT_FALSE(run_for(simulation, 2.0));
    World const& world = simulation.world();
    expect_at(centre_mm(world, world.objects[1]), {1500, 1500}, 5.0F);
    expect_at(world.bodies.position_mm[0], {400, 400}, 0.1F);
    expect_at(world.bodies.position_mm.back(), {1500, 1500}, 0.1F);
    // Against a wall, none of its bodies leaves the arena.
    simulation.move_object(1, {2500, 1000});
    ASSERT_FALSE(run_for(simulation, 0.5));
    for (Vec2 const place : world.bodies.position_mm) {
        EXPECT_TRUE(world.arena.contains(place));
    }
    EXPECT_GT(centre_mm(world, world.objects[1]).x, 1700.0F);
}

TEST(MoveByHand, ObjectInAPeriodicArenaComesOutOnTheOtherSide) {
    use_program(idle, idle);
    Scenario scenario = square_scene({robot_at({200, 200})});
    scenario.boundary = BoundaryCondition::periodic;
    Simulation simulation(testing::test_program(), scenario, {});
    start(simulation);
    EXPECT_TRUE(simulation.move_object(0, {1100, -50}));
    ASSERT_FALSE(simulation.step());
    expect_at(simulation.world().bodies.position_mm[0], {100, 950});
}

TEST(MoveByHand, FixedObjectCanBeMovedAndAWallCannot) {
    program_main = [] {
        pogobot_init();
        pogobot_start(idle, idle, "walls");
    };
    ObjectConfig block = at(passive_object({.radius_mm = 40.0F}), {300, 300});
    block.spec.body->fixed = true;
    Simulation simulation(testing::test_program(), square_scene({block, arena_wall()}), {});
    start(simulation);
    EXPECT_TRUE(simulation.move_object(0, {600, 600}));
    ASSERT_FALSE(run_for(simulation, 0.1));
    expect_at(simulation.world().bodies.position_mm[0], {600, 600});
    EXPECT_FALSE(simulation.move_object(1, {600, 600}));
}

TEST(Click, CallsTheCallbackInTheRobotsContext) {
    TemporaryFolder const folder;
    program_main = [] {
        pogobot_init();
        pogobot_start(idle, full_ahead, "robots");
        callback_robot_click = [] {
            auto& data = *static_cast<TestData*>(mydata);
            ++data.number[0];
            data.number[1] = pogobot_helper_getid();
            data.number[2] = pogobot_ticks;
            pogobot_led_setColors(0, 255, 0, 0);
        };
    };
    Simulation simulation(testing::test_program(),
                          recorded(square_scene({robot_at({200, 200}), robot_at({200, 500})}), folder / "a.feather"),
                          {});
    start(simulation);
    ASSERT_FALSE(run_for(simulation, 0.5));
    EXPECT_FALSE(simulation.click(1));
    EXPECT_FALSE(simulation.click(1));
    EXPECT_EQ(simulation.world().robots.led[0][0], Rgb{});
    EXPECT_EQ(simulation.world().robots.led[1][0], (Rgb{0, 255, 0}));
    auto const* const data = reinterpret_cast<TestData const*>(simulation.controllers().controller_of(1).user_data);
    EXPECT_EQ(data->number[0], 2);
    EXPECT_EQ(data->number[1], 1);
    EXPECT_EQ(data->number[2], simulation.controllers().ticks(1));
    simulation.finish();
    EXPECT_EQ(touched(folder / "a.feather"), "2 times from t = 0.5000 s on: robots clicked");
}

TEST(Click, FailureOfTheCallbackEndsTheRunLikeOthers) {
    program_main = [] {
        pogobot_init();
        pogobot_start(idle, idle, "robots");
        callback_robot_click = [] { std::abort(); };
    };
    Simulation simulation(testing::test_program(), square_scene({robot_at({200, 200})}), {});
    start(simulation);
    auto const failure = simulation.click(0);
    ASSERT_TRUE(failure);
    EXPECT_EQ(failure->code, ExitCode::user_program);
}

TEST(Touch, UntouchedRunHasTheSameBytesAndNoEntry) {
    TemporaryFolder const folder;
    use_program(idle, full_ahead);
    auto const run = [&folder](std::string const& name, bool clicked) {
        Simulation simulation(testing::test_program(), recorded(square_scene({robot_at({200, 200})}), folder / name),
                              {});
        EXPECT_FALSE(simulation.start());
        EXPECT_FALSE(run_for(simulation, 0.5));
        if (clicked) {
            EXPECT_FALSE(simulation.click(0));  // the program has no callback
            EXPECT_FALSE(simulation.move_object(0, centre_mm(simulation.world(), simulation.world().objects[0])));
        }
        simulation.finish();
        return bytes_of(folder / name);
    };
    std::string const plain = run("a.feather", false);
    EXPECT_EQ(run("a.feather", true), plain);
    EXPECT_EQ(touched(folder / "a.feather"), std::nullopt);
}

TEST(Touch, EntryIsThereInAFileOfManyBatches) {
    TemporaryFolder const folder;
    use_program(idle, full_ahead);
    Scenario scenario = recorded(square_scene({robot_at({200, 200}), robot_at({200, 500})}), folder / "a.feather");
    scenario.output.flush_row_count = 3;
    Simulation simulation(testing::test_program(), scenario, {});
    start(simulation);
    ASSERT_FALSE(run_for(simulation, 1.0));
    EXPECT_TRUE(simulation.move_object(1, {300, 700}));
    ASSERT_FALSE(run_for(simulation, 1.0));
    simulation.finish();
    EXPECT_EQ(touched(folder / "a.feather"), "once, at t = 1.0000 s: objects moved by hand");
    EXPECT_EQ(read_back(folder / "a.feather").table->num_rows(), 42);
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.feather"});
}

TEST(Touches, MovesOfOneObjectInARowCountOnce) {
    Touches touches;
    EXPECT_EQ(touches.text(), "");
    for (int i = 0; i < 100; ++i) {
        touches.add_move(3, 1.23 + 0.01 * i);
    }
    EXPECT_EQ(touches.text(), "once, at t = 1.2300 s: objects moved by hand");
    touches.add_move(4, 2.23);
    touches.add_move(3, 2.24);
    EXPECT_EQ(touches.text(), "3 times from t = 1.2300 s on: objects moved by hand");
    touches.add_move(3, 5.0);
    touches.add(Touch::click, 5.0);
    touches.add_move(3, 5.0);
    EXPECT_EQ(touches.text(), "6 times from t = 1.2300 s on: objects moved by hand 5 times, robots clicked once");
}

}  // namespace
}  // namespace pogosim
