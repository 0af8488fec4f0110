// What counts as touching: the gaps that an engine leaves between bodies, and to walls, are none.
#include "sim/touching.hpp"

#include <gtest/gtest.h>

#include "support/small_world.hpp"

namespace pogosim {
namespace {

constexpr float kRadiusMm = 26.5F;

TEST(Touching, ReachesOverTheGapThatTheEngineLeavesToWalls) {
    World world = testing::square_world();
    testing::add_robot(world, {kRadiusMm + 2.0F, 500});
    Object const robot{.robot = 0, .body = 0, .body_count = 1};
    world.objects = {robot};
    EXPECT_TRUE(touched_by(world, world.objects[0], {.bodies_mm = 0.0F, .walls_mm = 1.0F}).wall);
    EXPECT_FALSE(touched_by(world, world.objects[0], {.bodies_mm = 1.0F, .walls_mm = 0.0F}).wall);
}

TEST(Touching, ReachesOverTheGapThatTheEngineLeavesBetweenBodies) {
    World world = testing::square_world();
    testing::add_robot(world, {500, 500});
    testing::add_robot(world, {500 + 2.0F * kRadiusMm + 2.0F, 500});
    world.objects = {{.robot = 0, .body = 0, .body_count = 1}, {.robot = 1, .body = 1, .body_count = 1}};
    EXPECT_EQ(touched_by(world, world.objects[0], {.bodies_mm = 1.0F, .walls_mm = 0.0F}).objects,
              std::vector<std::uint32_t>{1});
    EXPECT_TRUE(touched_by(world, world.objects[0], {.bodies_mm = 0.0F, .walls_mm = 1.0F}).objects.empty());
}

}  // namespace
}  // namespace pogosim
