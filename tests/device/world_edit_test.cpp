// Changes of the world from outside of the robots.
#include "device/world_edit.hpp"

#include <gtest/gtest.h>

#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_robot;
using testing::square_world;

WorldEdit edit_of_half_a_world() {
    WorldEdit edit;
    edit.is_free = [](Object const& /*object*/, Vec2 place_mm) { return place_mm.x < 500.0F; };
    return edit;
}

TEST(WorldEdit, MovesWhatHasABodyToPlacesFreeOfWalls) {
    World world = square_world();
    add_robot(world, {100, 100});
    WorldEdit edit = edit_of_half_a_world();
    EXPECT_TRUE(edit.set_pose(world, world.objects[0], {300, 200}, 1.0F));
    EXPECT_EQ(world.bodies.position_mm[0], (Vec2{300, 200}));
    EXPECT_FALSE(edit.set_pose(world, world.objects[0], {600, 200}, 1.0F));
    EXPECT_FALSE(edit.set_pose(world, Object{.body = kNone}, {300, 200}, 1.0F));
    EXPECT_EQ(world.bodies.position_mm[0], (Vec2{300, 200}));
}

TEST(WorldEdit, EngineIsToldWhatWasWritten) {
    World world = square_world();
    add_robot(world, {100, 100}, 0.5F);
    WorldEdit edit = edit_of_half_a_world();
    edit.set_pose(world, world.objects[0], {300, 200}, 1.0F);
    edit.set_pose(world, world.objects[0], {300, 200}, 1.0F);
    set_velocity(world.bodies, 0, {1, 2}, 3.0F);
    std::vector<WrittenBody> const expected{{0, true}, {0, false}, {0, false}};
    EXPECT_EQ(world.bodies.written, expected);
}

TEST(WorldEdit, LightIsComputedOnceForAllSettingsBefore) {
    World world = square_world();
    world.lamps.resize(2);
    WorldEdit edit;
    int updates = 0;
    edit.update_light = [&updates] { ++updates; };
    edit.settle_light();
    EXPECT_EQ(updates, 0);
    edit.set_lamp(world, 0, {.is_on = false, .intensity = 1.0F, .moved_mm = {}});
    edit.set_lamp(world, 1, {.is_on = true, .intensity = 0.5F, .moved_mm = {}});
    EXPECT_FALSE(world.lamps[0].setting.is_on);
    EXPECT_EQ(world.lamps[1].setting.intensity, 0.5F);
    edit.settle_light();
    edit.settle_light();
    EXPECT_EQ(updates, 1);
}

TEST(WorldEdit, LampThatIsMovedKeepsItsOtherSettings) {
    PlacedLamp lamp{
        .category = "sun", .start_mm = {0.1F, 0.2F}, .setting = {.is_on = false, .intensity = 2.0F, .moved_mm = {}}};
    LampSetting const moved = moved_to(lamp, {100, 200});
    EXPECT_FALSE(moved.is_on);
    EXPECT_EQ(moved.intensity, 2.0F);
    EXPECT_EQ(moved.moved_mm, (Vec2{100, 200} - lamp.start_mm));
    lamp.setting.moved_mm = {1e-7F, 0};  // less than a place shows
    EXPECT_EQ(moved_to(lamp, lamp.place_mm()).moved_mm, lamp.setting.moved_mm);
}

}  // namespace
}  // namespace pogosim
