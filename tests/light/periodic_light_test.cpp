// Lamps across the borders of a periodic arena: for every type, moving a lamp moves its light unchanged.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <type_traits>
#include <vector>

#include "lit_world.hpp"

namespace pogosim {
namespace {

constexpr int kCells = 100;  // along either side, 10 mm each

World periodic_world(std::vector<LampSpec> const& lamps, double time_s = 0.0) {
    World world = testing::square_world();
    world.periodic = true;
    world.light = make_light_map(world.arena, world.periodic, kCells, kCells);
    world.step = std::lround(time_s / world.time_step_s);
    Lighting(lamps, world).update(world);
    return world;
}

int level(World const& world, int column, int row) {
    auto const wrap = [](int cell) { return static_cast<std::size_t>(((cell % kCells) + kCells) % kCells); };
    return world.light.level[wrap(row) * kCells + wrap(column)];
}

/// Number of cells of one map that differ, by more than the rounding of a position on an orbit, from the cells of the
/// other map that are this many columns and rows further.
int cells_that_differ(World const& world, World const& moved, int columns, int rows) {
    int count = 0;
    for (int row = 0; row < kCells; ++row) {
        for (int column = 0; column < kCells; ++column) {
            count += std::abs(level(world, column, row) - level(moved, column + columns, row + rows)) > 1 ? 1 : 0;
        }
    }
    return count;
}

Shape shape_of(ShapeKind kind) {
    return {.kind = kind, .radius_mm = 223, .width_mm = 300, .height_mm = 177, .side_length_mm = 433};
}

template <class Spec>
void expect_the_same_everywhere(Spec lamp, double time_s, std::string const& what) {
    bool const is_lighthouse_of_all = !std::is_same_v<Spec, SpotSpec> && is_everywhere(lamp.shape);
    lamp.centre_mm = is_lighthouse_of_all ? Vec2{} : Vec2{505, 505};
    World const middle = periodic_world({lamp}, time_s);
    Vec2 const start = lamp.centre_mm;
    for (auto const& [columns, rows] : {std::pair{-50, 0}, {49, 0}, {-48, -50}, {30, 49}, {20, -130}}) {
        lamp.centre_mm = start + Vec2{10.0F * static_cast<float>(columns), 10.0F * static_cast<float>(rows)};
        EXPECT_EQ(cells_that_differ(middle, periodic_world({lamp}, time_s), columns, rows), 0)
            << what << ", moved by " << columns << ", " << rows << " cells";
    }
}

TEST(PeriodicLight, OfEverySpotIsTheSameAtTheSeam) {
    for (ShapeKind const kind : {ShapeKind::disk, ShapeKind::rectangle, ShapeKind::triangle, ShapeKind::global}) {
        for (LightMode const mode : {LightMode::uniform, LightMode::gradient, LightMode::plane}) {
            SpotSpec lamp;
            lamp.shape = shape_of(kind);
            lamp.mode = mode;
            lamp.value = 20000;
            lamp.edge_value = 100;
            lamp.plane_angle_rad = 0.5F;
            lamp.plane_half_span_mm = 250.0F;
            std::string const what =
                "shape " + std::to_string(static_cast<int>(kind)) + ", mode " + std::to_string(static_cast<int>(mode));
            expect_the_same_everywhere(lamp, 0.0, what);
            lamp.orbit = {.radius_mm = 400.0F, .angular_speed_rad_s = std::numbers::pi, .phase_rad = 0.0};
            expect_the_same_everywhere(lamp, 1.0, what + ", on an orbit");
        }
    }
}

TEST(PeriodicLight, OfEveryLighthouseIsTheSameAtTheSeam) {
    for (ShapeKind const kind : {ShapeKind::disk, ShapeKind::rectangle, ShapeKind::triangle, ShapeKind::global}) {
        std::string const what = "shape " + std::to_string(static_cast<int>(kind));
        for (double const time_s : {0.01, 0.5, 1.2, 2.0}) {
            RotatingRaySpec ray;
            ray.shape = shape_of(kind);
            expect_the_same_everywhere(ray, time_s, what);
            AlternatingRaysSpec rays;
            rays.shape = shape_of(kind);
            expect_the_same_everywhere(rays, time_s, what);
        }
    }
}

TEST(PeriodicLight, OfADiskIsAsFarFromItsCentreAsItsRadiusAcrossTheSeam) {
    SpotSpec lamp = testing::disk_lamp(1000);
    lamp.centre_mm = {5, 995};
    World const world = periodic_world({lamp});
    EXPECT_EQ(world.light.at({5, 805}), 1000);
    EXPECT_EQ(world.light.at({5, 795 - 10}), 0);
    EXPECT_EQ(world.light.at({5, 195}), 1000);  // 200 mm below, beyond the lower border
    EXPECT_EQ(world.light.at({5, 205}), 0);
    EXPECT_EQ(world.light.at({805, 995}), 1000);
    EXPECT_EQ(world.light.at({875, 145}), 1000);  // across the corner: 198 mm away
    EXPECT_EQ(world.light.at({865, 145}), 0);     // 205 mm
    EXPECT_EQ(testing::count_cells(world, 1000),
              testing::count_cells(testing::lit_world({testing::disk_lamp(1000)}), 1000));
}

TEST(PeriodicLight, OfAGradientFallsWithTheDistanceToTheNearestImage) {
    SpotSpec lamp = testing::global_lamp(10000);
    lamp.mode = LightMode::gradient;
    lamp.centre_mm = {5, 5};
    lamp.gradient_radius_mm = 1000.0F;
    World const world = periodic_world({lamp});
    testing::for_each_cell(world, [&](int at, Vec2 centre) {
        float const distance_mm = length(minimum_image(world, lamp.centre_mm, centre));
        EXPECT_NEAR(at, 10000.0F - 10.0F * distance_mm, 0.51F);
    });
}

TEST(PeriodicLight, CountsOnceHoweverFarALampReaches) {
    SpotSpec lamp = testing::disk_lamp(1000);
    lamp.shape.radius_mm = 5000.0F;
    lamp.centre_mm = {100, 900};
    EXPECT_EQ(testing::count_cells(periodic_world({lamp}), 1000), kCells * kCells);
}

TEST(PeriodicLight, OfALampInTheMiddleIsThatOfAnArenaWithWalls) {
    for (ShapeKind const kind : {ShapeKind::disk, ShapeKind::rectangle, ShapeKind::triangle, ShapeKind::global}) {
        for (LightMode const mode : {LightMode::uniform, LightMode::gradient, LightMode::plane}) {
            SpotSpec lamp;
            lamp.shape = shape_of(kind);
            lamp.mode = mode;
            lamp.value = 20000;
            lamp.centre_mm = {500, 500};
            EXPECT_EQ(periodic_world({lamp}).light.level, testing::lit_world({lamp}).light.level);
        }
    }
    for (double const time_s : {0.01, 0.5, 1.2, 2.0}) {
        AlternatingRaysSpec rays;
        rays.shape.kind = ShapeKind::global;
        EXPECT_EQ(periodic_world({rays}, time_s).light.level, testing::lit_world({rays}, time_s).light.level);
    }
}

TEST(PeriodicLight, EndsAtAWall) {
    SpotSpec lamp = testing::disk_lamp(1000);
    lamp.centre_mm = {5, 505};
    EXPECT_EQ(testing::lit_world({lamp}).light.at({995, 505}), 0);
    EXPECT_EQ(periodic_world({lamp}).light.at({995, 505}), 1000);
}

TEST(PeriodicLight, FollowsALampThatIsMovedAcrossTheSeam) {
    World world = testing::square_world();
    world.periodic = true;
    world.light = make_light_map(world.arena, world.periodic, kCells, kCells);
    world.lamps = {{.category = "lamp", .start_mm = {505, 505}, .setting = {}}};
    Lighting lighting({testing::disk_lamp(1000)}, world);
    lighting.update(world);
    World const before = periodic_world({testing::disk_lamp(1000)});
    world.lamps[0].setting.moved_mm = {480, 0};
    lighting.update(world);
    EXPECT_EQ(cells_that_differ(before, world, 48, 0), 0);
}

}  // namespace
}  // namespace pogosim
