#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <tuple>
#include <vector>

#include "lit_world.hpp"

namespace pogosim {
namespace {

using testing::count_cells;
using testing::expect_beam;
using testing::lit_world;

constexpr double kPi = std::numbers::pi;
constexpr Vec2 kCorner1{0, 1000};
constexpr Vec2 kCorner2{1000, 1000};

/// 0.5 s white, a sweep of 1 s, 0.1 s white, another sweep of 1 s: a cycle of 2.6 s.
AlternatingRaysSpec lighthouses() {
    AlternatingRaysSpec spec;
    spec.shape.kind = ShapeKind::global;
    spec.value = 500;
    spec.half_width_rad = 0.05;
    spec.angular_speed_rad_s = kPi / 2.0;
    spec.long_white_frame_duration_s = 0.5;
    spec.short_white_frame_duration_s = 0.1;
    return spec;
}

TEST(AlternatingRays, SweepRightAnglesFromTheTwoLowerCornersInTurn) {
    for (double const turned_s : {0.0, 0.1, 0.5, 0.63, 0.99}) {
        double const turned = kPi / 2.0 * turned_s;
        expect_beam(lit_world({lighthouses()}, 0.5 + turned_s), kCorner1, -kPi / 2.0 + turned, 0.05, 500, 0);
        expect_beam(lit_world({lighthouses()}, 1.6 + turned_s), kCorner2, -kPi + turned, 0.05, 500, 0);
    }
}

TEST(AlternatingRays, SweepBackWithANegativeSpeed) {
    AlternatingRaysSpec spec = lighthouses();
    spec.angular_speed_rad_s *= -1.0;
    expect_beam(lit_world({spec}, 0.5), kCorner1, 0.0, 0.05, 500, 0);
    expect_beam(lit_world({spec}, 0.9), kCorner1, -0.2 * kPi, 0.05, 500, 0);
    expect_beam(lit_world({spec}, 2.0), kCorner2, -kPi / 2.0 - 0.2 * kPi, 0.05, 500, 0);
}

TEST(AlternatingRays, FlashBeforeEachSweep) {
    World world = testing::dark_world();
    Lighting lighting({lighthouses()}, world);
    for (; world.step < 100000; world.step += 11) {
        lighting.update(world);
        std::int64_t const in_cycle = world.step % 260;
        bool const white = in_cycle < 50 || (in_cycle >= 150 && in_cycle < 160);
        ASSERT_EQ(count_cells(world, 32767) == 10000, white) << world.step;
    }
}

TEST(AlternatingRays, LightEveryCellOnceInEachSweep) {
    // Beams a step apart just touch each other: 0.005 pi wide.
    AlternatingRaysSpec spec = lighthouses();
    spec.half_width_rad = 0.0025 * kPi * (1.0 + 1e-6);
    World world = testing::dark_world();
    Lighting lighting({spec}, world);
    for (int const start : {50, 160}) {
        std::vector<int> times_lit(10000, 0);
        for (world.step = start; world.step < start + 100; ++world.step) {
            lighting.update(world);
            for (std::size_t cell = 0; cell < 10000; ++cell) {
                times_lit[cell] += world.light.level[cell] == 500 ? 1 : 0;
            }
        }
        // The sweep ends with the 100th step, so that the last half width before the wall is not lit.
        auto const once = std::ranges::count(times_lit, 1);
        EXPECT_GT(once, 9900) << start;
        EXPECT_EQ(std::ranges::count_if(times_lit, [](int n) { return n > 1; }), 0) << start;
    }
}

TEST(AlternatingRays, OfASmallShapeStandAtTheCornersOfItsBox) {
    AlternatingRaysSpec spec = lighthouses();
    spec.shape = {.kind = ShapeKind::rectangle, .width_mm = 400, .height_mm = 200};
    spec.centre_mm = {500, 300};
    spec.half_width_rad = 0.2;
    // The box is not square: the middle of the sweep, at half time, points to its centre.
    World const world = lit_world({spec}, 1.0);
    double const to_centre = std::atan2(-100.0, 200.0);
    testing::for_each_cell(world, [&](int level, Vec2 point) {
        bool const inside = contains(spec.shape, point - spec.centre_mm);
        double const off = testing::angle_between(testing::bearing({300, 400}, point), to_centre);
        ASSERT_EQ(level, inside && off <= 0.2 ? 500 : 0) << point.x << ' ' << point.y;
    });
    EXPECT_EQ(count_cells(lit_world({spec}, 0.0), 32767), 40 * 20);
}

TEST(AlternatingRays, InTheShapeOfTheArenaLightItsInsideOnly) {
    World world = testing::dark_world();
    world.arena.polygons = {{{0, 0}, {1000, 0}, {500, 1000}}};
    AlternatingRaysSpec spec = lighthouses();
    spec.shape.kind = ShapeKind::arena;
    Lighting lighting({spec}, world);
    lighting.update(world);
    testing::for_each_cell(
        world, [&](int level, Vec2 point) { ASSERT_EQ(level, contains(world.arena.polygons[0], point) ? 32767 : 0); });
    world.step = 100;  // ray 1 at -pi / 4
    lighting.update(world);
    EXPECT_EQ(world.light.at({505, 495}), 500);
    EXPECT_EQ(world.light.at({205, 795}), 0);  // in the beam, but outside
}

TEST(AlternatingRays, WithoutSpeedTheFirstBeamStaysAtItsStart) {
    AlternatingRaysSpec spec = lighthouses();
    spec.angular_speed_rad_s = 0.0;
    EXPECT_EQ(count_cells(lit_world({spec}, 0.49), 32767), 10000);
    expect_beam(lit_world({spec}, 1000.0), kCorner1, -kPi / 2.0, 0.05, 500, 0);
}

TEST(AlternatingRays, OverwriteWhatOtherLampsShine) {
    World const world = lit_world({lighthouses(), testing::global_lamp(2000)}, 1.0);
    expect_beam(world, kCorner1, -kPi / 4.0, 0.05, 500, 2000);
}

TEST(AlternatingRays, MarksStandInTheCornersAndPointAlongTheBeams) {
    World world = testing::dark_world();
    Lighting lighting({lighthouses()}, world);
    for (auto const& [time_s, first_is_on, second_is_on] :
         {std::tuple{0.2, false, false}, {0.9, true, false}, {1.55, false, false}, {2.2, false, true}}) {
        world.step = std::lround(time_s / world.time_step_s);
        lighting.update(world);
        auto const marks = lighting.marks();
        ASSERT_EQ(marks.size(), 2U);
        EXPECT_EQ(marks[0].centre_mm, kCorner1);
        EXPECT_EQ(marks[1].centre_mm, kCorner2);
        EXPECT_TRUE(marks[0].has_beam && marks[1].has_beam);
        EXPECT_EQ(marks[0].beam_is_on, first_is_on) << time_s;
        EXPECT_EQ(marks[1].beam_is_on, second_is_on) << time_s;
        for (LampMark const& mark : marks) {
            if (mark.beam_is_on) {
                expect_beam(world, mark.centre_mm, mark.beam_rad, 0.05, 500, 0);
            }
        }
    }
}

}  // namespace
}  // namespace pogosim
