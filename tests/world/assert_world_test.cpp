// Debug builds notice a world that contradicts itself; others have no such checks.
#include "world/assert_world.hpp"

#include <gtest/gtest.h>

#include "support/small_world.hpp"

namespace pogosim {
namespace {

World sound_world() {
    World world = testing::square_world();
    testing::add_robot(world, {200, 200});
    testing::add_robot(world, {400, 200});
    world.light = {.columns = 2, .rows = 1, .origin_mm = {}, .cell_mm = {500, 1000}, .level = {0, 0}};
    return world;
}

TEST(AssertStructure, SoundWorldPasses) {
    assert_structure(sound_world());
}

#ifdef NDEBUG
TEST(AssertStructure, IsForDebugBuildsOnly) {
    World world = sound_world();
    world.robots.led.pop_back();
    assert_structure(world);
}
#else
TEST(AssertStructure, EachContradictionIsNoticed) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    auto const expect_noticed = [](auto const& spoil) {
        World world = sound_world();
        spoil(world);
        EXPECT_DEATH(assert_structure(world), "Assert");
    };
    expect_noticed([](World& world) { world.robots.led.pop_back(); });
    expect_noticed([](World& world) { world.bodies.heading_dir.pop_back(); });
    expect_noticed([](World& world) { world.robots.body[1] = 2; });
    expect_noticed([](World& world) { world.robots.category[0] = 1; });
    expect_noticed([](World& world) { world.objects[1].robot = 0; });
    expect_noticed([](World& world) { world.light.level.pop_back(); });
    expect_noticed(
        [](World& world) { world.joints.push_back({.a = 0, .b = 7, .anchor_a_mm = {}, .anchor_b_mm = {}}); });
}
#endif

}  // namespace
}  // namespace pogosim
