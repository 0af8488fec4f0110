#include "light/lighting.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/small_world.hpp"

namespace pogosim {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

LampSpec disk_lamp(int value) {
    LampSpec lamp;
    lamp.shape.kind = ShapeKind::disk;
    lamp.shape.radius_mm = 200.0F;
    lamp.centre_mm = {500, 500};
    lamp.value = value;
    return lamp;
}

LampSpec global_lamp(int value) {
    LampSpec lamp;
    lamp.shape.kind = ShapeKind::global;
    lamp.value = value;
    return lamp;
}

World lit_world(std::vector<LampSpec> const& lamps, double time_s = 0.0) {
    World world = testing::square_world();
    world.light = make_light_map(world.arena, 100, 100);
    world.step = std::lround(time_s / world.time_step_s);
    Lighting lighting(lamps);
    lighting.update(world);
    return world;
}

TEST(Lighting, LampShinesInsideItsShapeOnly) {
    World const world = lit_world({disk_lamp(1000)});
    EXPECT_EQ(world.light.at({500, 500}), 1000);
    EXPECT_EQ(world.light.at({690, 500}), 1000);
    EXPECT_EQ(world.light.at({715, 500}), 0);
    EXPECT_EQ(world.light.at({660, 660}), 0);
}

TEST(Lighting, LampsAddUpToTheSensorsMaximum) {
    World const world = lit_world({global_lamp(200), disk_lamp(1000), disk_lamp(32767)});
    EXPECT_EQ(world.light.at({100, 100}), 200);
    EXPECT_EQ(world.light.at({500, 500}), 32767);
}

TEST(Lighting, GradientFallsLinearlyFromTheCentre) {
    LampSpec lamp = disk_lamp(30000);
    lamp.mode = LightMode::gradient;
    lamp.edge_value = 0;
    Arena const arena = testing::square_world().arena;
    EXPECT_EQ(lamp_level(lamp, arena, {500, 500}, 0.0), 30000);
    EXPECT_EQ(lamp_level(lamp, arena, {600, 500}, 0.0), 15000);
    EXPECT_EQ(lamp_level(lamp, arena, {500, 350}, 0.0), 7500);
    lamp.gradient_radius_mm = 100.0F;
    EXPECT_EQ(lamp_level(lamp, arena, {550, 500}, 0.0), 15000);
    EXPECT_EQ(lamp_level(lamp, arena, {650, 500}, 0.0), 0);
}

TEST(Lighting, GlobalGradientReachesTheFarthestCorner) {
    LampSpec lamp = global_lamp(10000);
    lamp.mode = LightMode::gradient;
    lamp.centre_mm = {0, 0};
    Arena const arena = testing::square_world().arena;
    EXPECT_EQ(lamp_level(lamp, arena, {1000, 1000}, 0.0), 0);
    EXPECT_NEAR(lamp_level(lamp, arena, {500, 500}, 0.0), 5000, 1);
}

TEST(Lighting, PlaneRisesAlongItsNormal) {
    LampSpec lamp = global_lamp(30000);
    lamp.mode = LightMode::plane;
    lamp.edge_value = 5000;
    lamp.centre_mm = {500, 500};
    lamp.plane_angle_rad = kPi / 2.0F;  // down the screen
    lamp.plane_half_span_mm = 500.0F;
    Arena const arena = testing::square_world().arena;
    EXPECT_EQ(lamp_level(lamp, arena, {123, 0}, 0.0), 30000);
    EXPECT_EQ(lamp_level(lamp, arena, {900, 500}, 0.0), 17500);
    EXPECT_EQ(lamp_level(lamp, arena, {500, 1000}, 0.0), 5000);
}

TEST(Lighting, PhotoStartIsDarkThenFlashesThenShines) {
    LampSpec lamp = global_lamp(200);
    lamp.photo_start_at_s = 1.0F;
    lamp.photo_start_duration_s = 0.5F;
    lamp.photo_start_value = 30000;
    EXPECT_EQ(lit_world({lamp}, 0.0).light.at({500, 500}), 0);
    EXPECT_EQ(lit_world({lamp}, 0.99).light.at({500, 500}), 0);
    EXPECT_EQ(lit_world({lamp}, 1.0).light.at({500, 500}), 30000);
    EXPECT_EQ(lit_world({lamp}, 1.49).light.at({500, 500}), 30000);
    EXPECT_EQ(lit_world({lamp}, 1.5).light.at({500, 500}), 200);
}

TEST(Lighting, MapFollowsTheTime) {
    LampSpec lamp = global_lamp(200);
    lamp.photo_start_at_s = 0.02F;
    lamp.photo_start_duration_s = 0.01F;
    World world = testing::square_world();
    world.light = make_light_map(world.arena, 10, 10);
    Lighting lighting({lamp});
    std::vector<int> levels;
    for (world.step = 0; world.step < 5; ++world.step) {
        lighting.update(world);
        levels.push_back(world.light.at({500, 500}));
    }
    EXPECT_EQ(levels, (std::vector<int>{0, 0, 32767, 200, 200}));
}

TEST(Lighting, LevelsOutsideTheMapAreThoseOfTheNearestCell) {
    World const world = lit_world({disk_lamp(1000), global_lamp(7)});
    EXPECT_EQ(world.light.at({-50, 500}), 7);
    EXPECT_EQ(world.light.at({5000, 5000}), 7);
}

}  // namespace
}  // namespace pogosim
