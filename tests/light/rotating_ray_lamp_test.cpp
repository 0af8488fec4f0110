#include <gtest/gtest.h>

#include <numbers>

#include "lit_world.hpp"

namespace pogosim {
namespace {

using testing::count_cells;
using testing::expect_beam;
using testing::lit_world;

constexpr double kPi = std::numbers::pi;
constexpr Vec2 kCentre{500, 500};

/// In the middle of the map; flashes for 0.1 s, then turns once in 2 s.
RotatingRaySpec lighthouse() {
    RotatingRaySpec spec;
    spec.shape.kind = ShapeKind::global;
    spec.value = 500;
    spec.half_width_rad = 0.15;
    spec.angular_speed_rad_s = kPi;
    spec.white_frame_duration_s = 0.1;
    spec.white_frame_value = 30000;
    return spec;
}

TEST(RotatingRay, LightsWhatIsSeenWithinItsHalfWidth) {
    for (double const turned_s : {0.0, 0.01, 0.25, 0.5, 0.77, 1.0, 1.5, 1.99}) {
        expect_beam(lit_world({lighthouse()}, 0.1 + turned_s), kCentre, kPi * turned_s, 0.15, 500, 0);
    }
}

TEST(RotatingRay, TurnsTheOtherWayWithANegativeSpeed) {
    RotatingRaySpec spec = lighthouse();
    spec.angular_speed_rad_s = -kPi;
    for (double const turned_s : {0.0, 0.3, 0.5, 1.2, 1.9}) {
        expect_beam(lit_world({spec}, 0.1 + turned_s), kCentre, -kPi * turned_s, 0.15, 500, 0);
    }
    EXPECT_EQ(count_cells(lit_world({spec}, 2.1), 30000), 10000);
}

TEST(RotatingRay, FlashesAtTheStartAndAfterEachTurn) {
    World world = testing::dark_world();
    Lighting lighting({lighthouse()}, world);
    // The cycle is 2.1 s long: 10 white steps, then 200 steps of beam. Steps of 11 come to each place in it.
    for (; world.step < 100000; world.step += 11) {
        lighting.update(world);
        bool const all_white = count_cells(world, 30000) == 10000;
        ASSERT_EQ(all_white, world.step % 210 < 10) << world.step;
    }
}

TEST(RotatingRay, LooksTheSameAfterACycle) {
    for (double const time_s : {0.05, 0.1, 0.5, 1.3, 2.0}) {
        EXPECT_EQ(lit_world({lighthouse()}, time_s).light.level, lit_world({lighthouse()}, time_s + 2.1).light.level);
    }
    expect_beam(lit_world({lighthouse()}, 0.6 + 1000 * 2.1), kCentre, kPi * 0.5, 0.15, 500, 0);
}

TEST(RotatingRay, WithoutFlashTurnsOn) {
    RotatingRaySpec spec = lighthouse();
    spec.white_frame_duration_s = 0.0;
    for (double const time_s : {0.0, 1.99, 2.0, 2.5}) {
        expect_beam(lit_world({spec}, time_s), kCentre, kPi * time_s, 0.15, 500, 0);
    }
}

TEST(RotatingRay, WithoutSpeedStaysAtAngleZeroAfterOneFlash) {
    RotatingRaySpec spec = lighthouse();
    spec.angular_speed_rad_s = 0.0;
    EXPECT_EQ(count_cells(lit_world({spec}, 0.0), 30000), 10000);
    expect_beam(lit_world({spec}, 0.1), kCentre, 0.0, 0.15, 500, 0);
    expect_beam(lit_world({spec}, 12345.0), kCentre, 0.0, 0.15, 500, 0);
}

TEST(RotatingRay, IsDarkUntilItsPhotoStartIsOver) {
    RotatingRaySpec spec = lighthouse();
    spec.photo_start_at_s = 1.0;
    spec.photo_start_duration_s = 0.5;
    EXPECT_EQ(count_cells(lit_world({spec}, 0.0), 0), 10000);
    EXPECT_EQ(count_cells(lit_world({spec}, 1.49), 0), 10000);
    EXPECT_EQ(count_cells(lit_world({spec}, 1.5), 30000), 10000);
    expect_beam(lit_world({spec}, 2.1), kCentre, kPi * 0.5, 0.15, 500, 0);
}

TEST(RotatingRay, OverwritesWhatOtherLampsShine) {
    World const world = lit_world({lighthouse(), testing::global_lamp(2000)}, 0.6);
    expect_beam(world, kCentre, kPi * 0.5, 0.15, 500, 2000);
    EXPECT_EQ(count_cells(lit_world({lighthouse(), testing::global_lamp(2000)}, 0.0), 30000), 10000);
}

TEST(RotatingRay, StaysInsideItsShape) {
    RotatingRaySpec spec = lighthouse();
    spec.shape = {.kind = ShapeKind::disk, .radius_mm = 100.0F};
    spec.centre_mm = {300, 700};
    spec.half_width_rad = kPi;
    testing::for_each_cell(lit_world({spec}, 0.5), [&](int level, Vec2 point) {
        ASSERT_EQ(level, length(point - spec.centre_mm) <= 100.0F ? 500 : 0) << point.x << ' ' << point.y;
    });
    spec.half_width_rad = 0.2;
    World const world = lit_world({spec}, 0.1);
    EXPECT_EQ(world.light.at({385, 705}), 500);
    EXPECT_EQ(world.light.at({405, 705}), 0);
    EXPECT_EQ(world.light.at({285, 705}), 0);
}

TEST(RotatingRay, StandsWhereItsCentreSaysFromTheMiddleOfTheMap) {
    RotatingRaySpec spec = lighthouse();
    spec.centre_mm = {-300, 100};
    expect_beam(lit_world({spec}, 0.8), {200, 600}, kPi * 0.7, 0.15, 500, 0);
    spec.shape.kind = ShapeKind::arena;
    expect_beam(lit_world({spec}, 0.8), {200, 600}, kPi * 0.7, 0.15, 500, 0);
}

TEST(RotatingRay, MarkPointsAlongTheBeam) {
    World world = testing::dark_world();
    Lighting lighting({lighthouse()}, world);
    for (; world.step < 500; world.step += 7) {
        lighting.update(world);
        auto const marks = lighting.marks();
        ASSERT_EQ(marks.size(), 1U);
        EXPECT_EQ(marks[0].centre_mm, kCentre);
        EXPECT_TRUE(marks[0].has_beam);
        EXPECT_EQ(marks[0].beam_is_on, world.step % 210 >= 10) << world.step;
        if (marks[0].beam_is_on) {
            expect_beam(world, kCentre, marks[0].beam_rad, 0.15, 500, 0);
        }
    }
}

}  // namespace
}  // namespace pogosim
