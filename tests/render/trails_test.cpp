#include "render/trails.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_robot;
using testing::square_world;

TEST(Trail, OfARobotThatStandsStillIsOnePoint) {
    World world = square_world();
    add_robot(world, {100, 200});
    Trails trails;
    for (int step = 0; step < 10; ++step) {
        trails.follow(world);
    }
    ASSERT_EQ(trails.size(0), 1U);
    EXPECT_EQ(trails.point(0, 0).position_mm, (Vec2{100, 200}));
}

TEST(Trail, HasPointsAtLeastTwoMillimetresApart) {
    World world = square_world();
    add_robot(world, {100, 200});
    Trails trails;
    for (int step = 0; step < 100; ++step) {
        world.bodies.position_mm[0].x += 0.3F;
        trails.follow(world);
    }
    ASSERT_GT(trails.size(0), 10U);
    for (std::size_t age = 1; age < trails.size(0); ++age) {
        float const apart = length(trails.point(0, age).position_mm - trails.point(0, age - 1).position_mm);
        EXPECT_GE(apart, Trails::kSpacingMm);
        EXPECT_LT(apart, Trails::kSpacingMm + 0.31F);
    }
}

TEST(Trail, ForgetsTheOldestPoints) {
    World world = square_world(5000.0F);
    add_robot(world, {0, 200});
    Trails trails;
    for (int step = 0; step < 1000; ++step) {
        trails.follow(world);
        world.bodies.position_mm[0].x += 3.0F;
    }
    ASSERT_EQ(trails.size(0), Trails::kLength);
    EXPECT_FLOAT_EQ(trails.point(0, 0).position_mm.x, 999 * 3.0F);
    EXPECT_FLOAT_EQ(trails.point(0, Trails::kLength - 1).position_mm.x, (1000 - 512) * 3.0F);
}

TEST(Trail, IsShorterWhereTheSwarmWouldNeedMoreMemoryThanAllowed) {
    World world = square_world(5000.0F);
    add_robot(world, {0, 200});
    add_robot(world, {0, 400});
    Trails trails(2 * 100 * sizeof(TrailPoint));
    for (int step = 0; step < 1000; ++step) {
        trails.follow(world);
        world.bodies.position_mm[0].x += 3.0F;
        world.bodies.position_mm[1].x += 2.0F;
    }
    ASSERT_EQ(trails.size(0), 100U);
    EXPECT_FLOAT_EQ(trails.point(0, 0).position_mm.x, 999 * 3.0F);
    EXPECT_FLOAT_EQ(trails.point(1, 99).position_mm.x, 900 * 2.0F);
}

TEST(Trail, RemembersTheColourOfTheTime) {
    World world = square_world();
    add_robot(world, {100, 200});
    Trails trails;
    world.robots.led[0][0] = {25, 0, 0};
    trails.follow(world);
    world.robots.led[0][0] = {0, 25, 0};
    world.bodies.position_mm[0].x += 5.0F;
    trails.follow(world);
    EXPECT_EQ(trails.point(0, 0).led, (Rgb{0, 25, 0}));
    EXPECT_EQ(trails.point(0, 1).led, (Rgb{25, 0, 0}));
}

TEST(Trail, StaysInsideAPeriodicArenaAndMeasuresAcrossItsSeam) {
    World world = square_world();
    world.periodic = true;
    add_robot(world, {999.5F, 200});
    Trails trails;
    trails.follow(world);
    world.bodies.position_mm[0] = {0.5F, 200};  // 1 mm on
    trails.follow(world);
    EXPECT_EQ(trails.size(0), 1U);
    world.bodies.position_mm[0] = {1002.0F, 200};  // as a body of physics may stand for a moment
    trails.follow(world);
    ASSERT_EQ(trails.size(0), 2U);
    EXPECT_NEAR(trails.point(0, 0).position_mm.x, 2.0F, 1e-3F);
}

TEST(Trail, IsLeftByRigidBodiesWithAProgramOnly) {
    World world = square_world();
    add_robot(world, {100, 200});
    world.categories[0].spec.membrane.emplace();
    Trails trails;
    trails.follow(world);
    EXPECT_EQ(trails.size(0), 0U);
    world.categories[0].spec.membrane.reset();
    world.robots.body[0] = kNone;
    trails.follow(world);
    EXPECT_EQ(trails.size(0), 0U);
}

TEST(Trail, LeavesOutPositionsThatAreNotFinite) {
    World world = square_world();
    add_robot(world, {100, 200});
    Trails trails;
    trails.follow(world);
    for (float const bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        world.bodies.position_mm[0].x = bad;
        trails.follow(world);
    }
    EXPECT_EQ(trails.size(0), 1U);
}

TEST(Trail, OfARecordingHasItsPointsNewestFirst) {
    std::vector<TrailPoint> const points{{{1, 0}, {}}, {{2, 0}, {}}, {{3, 0}, {25, 0, 0}}};
    std::vector<std::uint32_t> const counts{2, 0, 1};
    Trails trails;
    trails.take(points, counts, 10);
    ASSERT_EQ(trails.robot_count(), 3);
    EXPECT_EQ(trails.fading(), 10);
    ASSERT_EQ(trails.size(0), 2);
    EXPECT_EQ(trails.point(0, 0).position_mm, (Vec2{2, 0}));
    EXPECT_EQ(trails.point(0, 1).position_mm, (Vec2{1, 0}));
    EXPECT_EQ(trails.size(1), 0);
    ASSERT_EQ(trails.size(2), 1);
    EXPECT_EQ(trails.point(2, 0).led, (Rgb{25, 0, 0}));
}

TEST(Trail, OfARecordingKeepsItsLastPoints) {
    std::vector<TrailPoint> points;
    for (std::size_t i = 0; i < Trails::kLength + 3; ++i) {
        points.push_back({{static_cast<float>(i), 0}, {}});
    }
    std::vector<std::uint32_t> const counts{static_cast<std::uint32_t>(points.size())};
    Trails trails;
    trails.take(points, counts, 1);
    ASSERT_EQ(trails.size(0), Trails::kLength);
    EXPECT_EQ(trails.point(0, 0).position_mm.x, static_cast<float>(Trails::kLength + 2));
    EXPECT_EQ(trails.point(0, Trails::kLength - 1).position_mm.x, 3.0F);
}

}  // namespace
}  // namespace pogosim
