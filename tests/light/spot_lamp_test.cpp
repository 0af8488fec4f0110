#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "lit_world.hpp"

namespace pogosim {
namespace {

using testing::disk_lamp;
using testing::global_lamp;
using testing::lit_world;

constexpr double kPi = std::numbers::pi;

SpotSpec orbiting(SpotSpec lamp, float radius_mm, double angular_speed_rad_s, double phase_rad = 0.0) {
    lamp.orbit = {.radius_mm = radius_mm, .angular_speed_rad_s = angular_speed_rad_s, .phase_rad = phase_rad};
    return lamp;
}

TEST(SpotLamp, ShinesInsideItsShapeOnly) {
    World const world = lit_world({disk_lamp(1000)});
    EXPECT_EQ(world.light.at({505, 505}), 1000);
    EXPECT_EQ(world.light.at({695, 505}), 1000);
    EXPECT_EQ(world.light.at({715, 505}), 0);
    EXPECT_EQ(world.light.at({655, 655}), 0);
}

TEST(SpotLamp, LightsTheCellsWhoseCentreIsInItsShape) {
    for (ShapeKind const kind : {ShapeKind::disk, ShapeKind::rectangle, ShapeKind::triangle}) {
        SpotSpec lamp;
        lamp.value = 7;
        lamp.shape = {.kind = kind, .radius_mm = 123, .width_mm = 300, .height_mm = 77, .side_length_mm = 333};
        for (Vec2 const centre : {Vec2{400, 300}, Vec2{5, 5}, Vec2{990, 1000}, Vec2{-90, 500}, Vec2{500, 2000}}) {
            lamp.centre_mm = centre;
            int wrong = 0;
            testing::for_each_cell(lit_world({lamp}), [&](int level, Vec2 point) {
                wrong += level != (contains(lamp.shape, point - centre) ? 7 : 0) ? 1 : 0;
            });
            EXPECT_EQ(wrong, 0) << static_cast<int>(kind) << " at " << centre.x << ", " << centre.y;
        }
    }
}

TEST(SpotLamp, InTheShapeOfTheArenaShinesInHolesTooButNotOutside) {
    World world = testing::dark_world();
    world.arena.polygons = {{{100, 100}, {600, 100}, {600, 600}, {100, 600}}, {{200, 200}, {300, 200}, {300, 300}}};
    SpotSpec lamp;
    lamp.shape.kind = ShapeKind::arena;
    Lighting(std::vector<LampSpec>{lamp}, world).update(world);
    EXPECT_EQ(world.light.at({105, 595}), 10);
    EXPECT_EQ(world.light.at({295, 235}), 10);
    EXPECT_EQ(world.light.at({95, 300}), 0);
    EXPECT_EQ(testing::count_cells(world, 10), 50 * 50);
}

TEST(SpotLamp, GradientFallsLinearlyFromTheCentre) {
    SpotSpec lamp = disk_lamp(30000);
    lamp.mode = LightMode::gradient;
    World const world = lit_world({lamp});
    EXPECT_EQ(world.light.at({505, 505}), 30000);
    EXPECT_EQ(world.light.at({605, 505}), 15000);
    EXPECT_EQ(world.light.at({505, 355}), 7500);
    lamp.gradient_radius_mm = 100.0F;
    lamp.edge_value = 10000;
    World const narrow = lit_world({lamp});
    EXPECT_EQ(narrow.light.at({555, 505}), 20000);
    EXPECT_EQ(narrow.light.at({655, 505}), 10000);
}

TEST(SpotLamp, GlobalGradientReachesTheFarthestCorner) {
    SpotSpec lamp = global_lamp(10000);
    lamp.mode = LightMode::gradient;
    World const world = lit_world({lamp});
    EXPECT_EQ(world.light.at({995, 995}), 50);
    EXPECT_EQ(world.light.at({505, 505}), 4950);
}

TEST(SpotLamp, PlaneRisesAlongItsNormal) {
    SpotSpec lamp = global_lamp(30000);
    lamp.mode = LightMode::plane;
    lamp.edge_value = 5000;
    lamp.centre_mm = {500, 505};
    lamp.plane_angle_rad = static_cast<float>(kPi / 2.0);  // down the screen
    lamp.plane_half_span_mm = 400.0F;
    World const world = lit_world({lamp});
    EXPECT_EQ(world.light.at({123, 105}), 30000);
    EXPECT_EQ(world.light.at({123, 15}), 30000);
    EXPECT_EQ(world.light.at({900, 505}), 17500);
    EXPECT_EQ(world.light.at({500, 905}), 5000);
    EXPECT_EQ(world.light.at({500, 705}), 11250);
}

TEST(SpotLamp, PhotoStartIsDarkThenFlashesThenShines) {
    SpotSpec lamp = global_lamp(200);
    lamp.photo_start_at_s = 1.0F;
    lamp.photo_start_duration_s = 0.5F;
    lamp.photo_start_value = 30000;
    EXPECT_EQ(lit_world({lamp}, 0.0).light.at({500, 500}), 0);
    EXPECT_EQ(lit_world({lamp}, 0.99).light.at({500, 500}), 0);
    EXPECT_EQ(lit_world({lamp}, 1.0).light.at({500, 500}), 30000);
    EXPECT_EQ(lit_world({lamp}, 1.49).light.at({500, 500}), 30000);
    EXPECT_EQ(lit_world({lamp}, 1.5).light.at({500, 500}), 200);
}

TEST(SpotLamp, GoesRoundOnItsOrbit) {
    // A quarter turn a second, clockwise on the screen, from the top.
    SpotSpec lamp = orbiting(disk_lamp(1000), 300, kPi / 2.0, -kPi / 2.0);
    lamp.shape.radius_mm = 4.0F;  // one cell
    Vec2 const stations[] = {{505, 205}, {805, 505}, {505, 805}, {205, 505}};
    for (int second = 0; second < 9; ++second) {
        World const world = lit_world({lamp}, second);
        EXPECT_EQ(world.light.at(stations[second % 4]), 1000) << second;
        EXPECT_EQ(testing::count_cells(world, 1000), 1) << second;
    }
    EXPECT_EQ(lit_world({lamp}, 0.5).light.at({505.0F + 212.132F, 505.0F - 212.132F}), 1000);
    lamp.orbit.angular_speed_rad_s *= -1.0;
    EXPECT_EQ(lit_world({lamp}, 1.0).light.at(stations[3]), 1000);
    EXPECT_EQ(lit_world({lamp}, 3.0).light.at(stations[1]), 1000);
}

TEST(SpotLamp, WithoutRadiusOrSpeedStandsStill) {
    EXPECT_EQ(lit_world({orbiting(disk_lamp(1000), 0, 1.0)}, 2.0).light.level,
              lit_world({disk_lamp(1000)}).light.level);
    SpotSpec shifted = disk_lamp(1000);
    shifted.centre_mm = {505, 605};
    EXPECT_EQ(lit_world({orbiting(disk_lamp(1000), 100, 0.0, kPi / 2.0)}, 2.0).light.level,
              lit_world({shifted}).light.level);
}

TEST(SpotLamp, TakesGradientAndPlaneAlongOnItsOrbit) {
    SpotSpec lamp = orbiting(disk_lamp(30000), 100, kPi);
    lamp.mode = LightMode::gradient;
    World const world = lit_world({lamp}, 1.0);  // around (405, 505)
    EXPECT_EQ(world.light.at({405, 505}), 30000);
    EXPECT_EQ(world.light.at({405, 605}), 15000);
    EXPECT_EQ(world.light.at({615, 505}), 0);
    lamp.shape.kind = ShapeKind::global;  // now to the farthest corner, (1000, 0) or (1000, 1000)
    EXPECT_EQ(lit_world({lamp}, 1.0).light.at({995, 505}), 30000 - std::lround(30000 * 590 / std::hypot(595, 505)));
    lamp.mode = LightMode::plane;
    lamp.plane_half_span_mm = 300.0F;
    EXPECT_EQ(lit_world({lamp}, 1.0).light.at({405, 5}), 15000);
    EXPECT_EQ(lit_world({lamp}, 1.0).light.at({555, 5}), 7500);
    EXPECT_EQ(lit_world({lamp}, 2.0).light.at({605, 5}), 15000);
}

TEST(SpotLamp, OnAnOrbitHasItsPhotoStart) {
    SpotSpec lamp = orbiting(disk_lamp(500), 100, kPi);
    lamp.photo_start_at_s = 1.0F;
    EXPECT_EQ(testing::count_cells(lit_world({lamp}, 0.5), 0), 10000);
    EXPECT_EQ(lit_world({lamp}, 1.0).light.at({405, 505}), 32767);
    EXPECT_EQ(lit_world({lamp}, 2.0).light.at({605, 505}), 500);
}

}  // namespace
}  // namespace pogosim
