// Poses and velocities written to the world from outside, as by a drag in the window, take effect.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "base/random.hpp"
#include "physics/coinciding_centres.hpp"
#include "physics/free_places.hpp"
#include "physics/physics_engine.hpp"
#include "support/each_engine.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_robot;
using testing::make_engine;
using testing::square_world;

class Written : public testing::EachEngine {};

constexpr float kRadius = 26.5F;
constexpr float kPi = std::numbers::pi_v<float>;

void run(PhysicsEngine& engine, World& world, int steps) {
    for (int i = 0; i < steps; ++i) {
        engine.advance(world);
    }
}

void expect_at(Vec2 place, Vec2 expected, float tolerance_mm = 0.05F) {
    EXPECT_NEAR(place.x, expected.x, tolerance_mm);
    EXPECT_NEAR(place.y, expected.y, tolerance_mm);
}

World world_with_hole() {
    World world = square_world();
    world.arena = make_arena({world.arena.polygons[0], {{400, 400}, {600, 400}, {600, 600}, {400, 600}}});
    return world;
}

TEST_P(Written, BodyIsAtRestAtTheNewPlaceAndStaysThere) {
    World world = square_world();
    add_robot(world, {200, 200});
    world.bodies.velocity_mm_s[0] = {100, 50};
    world.bodies.angular_velocity_rad_s[0] = 3.0F;
    auto const engine = make_engine(world, {});
    run(*engine, world, 20);
    set_pose(world, world.objects[0], {700, 600}, 1.5F);
    for (int steps : {0, 1, 100}) {
        run(*engine, world, steps);
        expect_at(world.bodies.position_mm[0], {700, 600});
        EXPECT_NEAR(world.bodies.heading_rad[0], 1.5F, 1e-5F);
        EXPECT_NEAR(world.bodies.heading_dir[0].y, std::sin(1.5F), 1e-5F);
        EXPECT_EQ(world.bodies.velocity_mm_s[0], Vec2{});
        EXPECT_EQ(world.bodies.angular_velocity_rad_s[0], 0.0F);
    }
}

TEST_P(Written, BodyCanBePutBeyondAWall) {
    World world = world_with_hole();
    add_robot(world, {200, 500});
    auto const engine = make_engine(world, {});
    run(*engine, world, 5);
    set_pose(world, world.objects[0], {800, 500}, 0.0F);
    run(*engine, world, 100);
    expect_at(world.bodies.position_mm[0], {800, 500});
}

TEST_P(Written, BodiesThatOverlapSeparateWithinASecond) {
    for (Vec2 const place : {Vec2{500, 500}, Vec2{510, 500}, Vec2{500, 540}}) {
        World world = square_world();
        add_robot(world, {200, 200});
        add_robot(world, {500, 500});
        auto const engine = make_engine(world, {});
        run(*engine, world, 200);  // everything sleeps
        set_pose(world, world.objects[0], place, 0.0F);
        run(*engine, world, 100);
        EXPECT_GT(length(world.bodies.position_mm[1] - world.bodies.position_mm[0]), 2.0F * kRadius - 1.0F);
    }
}

TEST_P(Written, FixedBodyIsMovedAndPushesOthersAway) {
    World world = square_world();
    ObjectSpec spec = testing::pogobot_spec();
    spec.body->fixed = true;
    add_robot(world, {200, 200}, 0.0F, spec);
    add_robot(world, {500, 500});
    auto const engine = make_engine(world, {});
    run(*engine, world, 200);
    set_pose(world, world.objects[0], {480, 500}, 0.0F);
    expect_at(world.bodies.position_mm[0], {480, 500});
    run(*engine, world, 100);
    expect_at(world.bodies.position_mm[0], {480, 500});
    EXPECT_GT(world.bodies.position_mm[1].x, 480.0F + 2.0F * kRadius - 1.0F);
}

TEST_P(Written, PoseAndVelocityOfOneStepTakeEffect) {
    World world = square_world();
    add_robot(world, {200, 200});
    world.bodies.velocity_mm_s[0] = {50, 0};
    auto const engine = make_engine(world, {});
    run(*engine, world, 10);
    set_pose(world.bodies, 0, {400, 700}, 0.5F);
    set_velocity(world.bodies, 0, {10, 0}, 0.0F);
    set_pose(world.bodies, 0, {500, 700}, 1.5F);
    set_velocity(world.bodies, 0, {50, 0}, 0.0F);
    run(*engine, world, 100);
    expect_at(world.bodies.position_mm[0], {550, 700}, 0.1F);
    EXPECT_NEAR(world.bodies.heading_dir[0].y, std::sin(1.5F), 1e-5F);
}

TEST_P(Written, VelocityTakesEffectAlsoOnABodyAsleep) {
    World world = square_world();
    add_robot(world, {200, 200});
    add_robot(world, {600, 600});
    auto const engine = make_engine(world, {});
    run(*engine, world, 200);
    set_velocity(world.bodies, 0, {100, 50}, 0.5F);
    run(*engine, world, 100);
    expect_at(world.bodies.position_mm[0], {300, 250}, 0.1F);
    EXPECT_NEAR(world.bodies.heading_rad[0], 0.5F, 1e-3F);
    expect_at(world.bodies.position_mm[1], {600, 600});
    set_velocity(world.bodies, 0, {}, 0.5F);
    run(*engine, world, 100);
    expect_at(world.bodies.position_mm[0], {300, 250}, 0.1F);
}

TEST_P(Written, FastBodyIsStoppedByWallsAndBodiesAlike) {
    World world = world_with_hole();
    add_robot(world, {100, 500});
    add_robot(world, {300, 500});
    auto const engine = make_engine(world, {});
    run(*engine, world, 5);
    set_velocity(world.bodies, 0, {15000, 0}, 0.0F);
    for (int i = 0; i < 100; ++i) {
        engine->advance(world);
        ASSERT_LT(world.bodies.position_mm[0].x, world.bodies.position_mm[1].x);
        ASSERT_LT(world.bodies.position_mm[1].x, 400.0F);
    }
}

TEST_P(Written, FixedBodyKeepsItsVelocityOfZero) {
    World world = square_world();
    ObjectSpec spec = testing::pogobot_spec();
    spec.body->fixed = true;
    add_robot(world, {200, 200}, 0.0F, spec);
    auto const engine = make_engine(world, {});
    set_velocity(world.bodies, 0, {100, 0}, 1.0F);
    EXPECT_TRUE(world.bodies.written.empty());
    run(*engine, world, 10);
    EXPECT_EQ(world.bodies.velocity_mm_s[0], Vec2{});
    expect_at(world.bodies.position_mm[0], {200, 200});
}

TEST_P(Written, WhatIsNotFiniteIsNotWritten) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float infinity = std::numeric_limits<float>::infinity();
    World world = square_world();
    add_robot(world, {200, 200}, 1.0F);
    auto const engine = make_engine(world, {});
    run(*engine, world, 5);
    auto const expect_unmoved = [&] {
        run(*engine, world, 3);
        expect_at(world.bodies.position_mm[0], {200, 200});
        EXPECT_NEAR(world.bodies.heading_rad[0], 1.0F, 1e-5F);
        EXPECT_NEAR(length(world.bodies.heading_dir[0]), 1.0F, 1e-5F);
        EXPECT_EQ(world.bodies.velocity_mm_s[0], Vec2{});
    };
    set_pose(world.bodies, 0, {nan, 300}, 0.0F);
    expect_unmoved();
    set_pose(world.bodies, 0, {300, 300}, infinity);
    expect_unmoved();
    set_velocity(world.bodies, 0, {0, -infinity}, 0.0F);
    expect_unmoved();
    set_velocity(world.bodies, 0, {}, nan);
    expect_unmoved();
}

TEST_P(Written, DriveOfAnotherThanTheProgramMovesARobot) {
    World world = square_world();
    add_robot(world, {200, 200});
    auto const engine = make_engine(world, {});
    run(*engine, world, 200);
    world.robots.command[0] = {.velocity_mm_s = {0, 100}, .pending = true};
    run(*engine, world, 100);
    expect_at(world.bodies.position_mm[0], {200, 300}, 0.1F);
}

TEST_P(Written, CrowdOnOneSpotSeparates) {
    World world = square_world();
    for (int i = 0; i < 12; ++i) {
        add_robot(world, {100.0F + 60.0F * static_cast<float>(i), 200});
    }
    auto const engine = make_engine(world, {});
    run(*engine, world, 5);
    for (Object const& object : world.objects) {
        set_pose(world, object, {500, 500}, 0.0F);
    }
    run(*engine, world, 1000);
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            EXPECT_GT(length(world.bodies.position_mm[i] - world.bodies.position_mm[k]), 2.0F * kRadius - 1.0F);
        }
    }
}

TEST(CoincidingCentres, OfMovedBodiesGoApartAndOthersStay) {
    std::vector<Vec2> places{{5, 5}, {5, 5}, {9, 5}, {5, 5}, {5, 6}};
    part_coinciding_centres(places, std::vector<std::uint32_t>{1, 3, 4});
    EXPECT_EQ(places, (std::vector<Vec2>{{5, 5}, {5 + kApartMm, 5}, {9, 5}, {5 + 2 * kApartMm, 5}, {5, 6}}));
}

TEST_P(Written, HundredsOfRandomMovesLeaveEverythingInsideTheArena) {
    World world = world_with_hole();
    RandomStream random(1, 0);
    std::vector<Vec2> const places{{100, 100}, {300, 100}, {500, 100}, {700, 100}, {900, 100}, {100, 300}, {100, 700}};
    for (Vec2 const place : places) {
        add_robot(world, place, random.uniform(-kPi, kPi));
    }
    auto const engine = make_engine(world, {});
    FreePlaces const free(world);
    for (int i = 0; i < 600; ++i) {
        auto const& object = world.objects[random.below(static_cast<std::uint32_t>(places.size()))];
        Vec2 const target{random.uniform(-300.0F, 1300.0F), random.uniform(-300.0F, 1300.0F)};
        Vec2 const place = free.nearest(object, target);
        ASSERT_TRUE(free.is_free(object, place) || place == centre_mm(world, object)) << i;
        set_pose(world, object, place, 0.0F);
        run(*engine, world, static_cast<int>(random.below(20)));
        for (Vec2 const position : world.bodies.position_mm) {
            ASSERT_TRUE(world.arena.contains(position)) << i;
            ASSERT_GT(world.arena.distance_to_walls(position), 0.45F * kRadius) << i;
        }
    }
}

TEST(FreePlaces, AreThoseWithoutAWallInTheBody) {
    World world = world_with_hole();
    add_robot(world, {200, 200});
    Object const& robot = world.objects[0];
    FreePlaces const free(world);
    EXPECT_TRUE(free.is_free(robot, {200, 200}));
    EXPECT_TRUE(free.is_free(robot, {kRadius, 500}));
    EXPECT_FALSE(free.is_free(robot, {kRadius - 1.0F, 500}));
    EXPECT_FALSE(free.is_free(robot, {-100, 500}));
    EXPECT_FALSE(free.is_free(robot, {500, 500}));
    EXPECT_FALSE(free.is_free(robot, {390, 500}));
    EXPECT_EQ(free.nearest(robot, {800, 700}), (Vec2{800, 700}));  // across the hole
}

TEST(FreePlaces, ObjectPushedAgainstAWallSlidesAlongIt) {
    World world = world_with_hole();
    add_robot(world, {200, 200});
    FreePlaces const free(world);
    expect_at(free.nearest(world.objects[0], {-500, 300}), {kRadius, 300}, 0.5F);
    expect_at(free.nearest(world.objects[0], {-500, -300}), {kRadius, kRadius}, 0.5F);
    // The hole stops it, too.
    world.bodies.position_mm[0] = {200, 500};
    expect_at(free.nearest(world.objects[0], {500, 520}), {400 - kRadius, 520}, 0.5F);
}

TEST(FreePlaces, AreEverywhereInAPeriodicWorld) {
    World world = square_world();
    world.periodic = true;
    add_robot(world, {200, 200});
    FreePlaces const free(world);
    EXPECT_TRUE(free.is_free(world.objects[0], {0, 1700}));
    EXPECT_EQ(free.nearest(world.objects[0], {0, 1700}), (Vec2{0, 1700}));
}

TEST(FreePlaces, ObjectWithoutABodyStaysWhereItIs) {
    World world = square_world();
    Object wall;
    wall.fixed_mm = {500, 500};
    FreePlaces const free(world);
    EXPECT_EQ(free.nearest(wall, {200, 200}), (Vec2{500, 500}));
}

POGOSIM_FOR_EACH_ENGINE(Written);

}  // namespace
}  // namespace pogosim
