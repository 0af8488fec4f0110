#include "light/lighting.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <utility>
#include <vector>

#include "base/random.hpp"
#include "lit_world.hpp"

namespace pogosim {
namespace {

using testing::disk_lamp;
using testing::global_lamp;
using testing::lit_world;

TEST(Lighting, LampsAddUpToTheSensorsMaximum) {
    World const world = lit_world({global_lamp(200), disk_lamp(1000), disk_lamp(32767)});
    EXPECT_EQ(world.light.at({100, 100}), 200);
    EXPECT_EQ(world.light.at({505, 505}), 32767);
}

TEST(Lighting, OrbitingLampsAddToTheOthers) {
    SpotSpec lamp = disk_lamp(1000);
    lamp.orbit = {.radius_mm = 100.0F, .angular_speed_rad_s = 1.0, .phase_rad = 0.0};
    World const world = lit_world({lamp, global_lamp(200), lamp});
    EXPECT_EQ(world.light.at({705, 505}), 2200);
    EXPECT_EQ(world.light.at({105, 505}), 200);
    lamp.value = 32767;
    EXPECT_EQ(lit_world({lamp, global_lamp(200)}).light.at({705, 505}), 32767);
}

TEST(Lighting, OfTwoRaysTheLaterOneWins) {
    RotatingRaySpec ray;
    ray.shape.kind = ShapeKind::global;
    ray.half_width_rad = std::numbers::pi;
    ray.white_frame_duration_s = 0.0;
    RotatingRaySpec narrow = ray;
    narrow.half_width_rad = 0.2;
    narrow.value = 700;
    testing::expect_beam(lit_world({ray, narrow}), {500, 500}, 0.0, 0.2, 700, 10);
    EXPECT_EQ(testing::count_cells(lit_world({narrow, ray}), 10), 10000);
}

/// Levels in the middle and 300 mm to the left of it, after setting the only lamp to this.
std::pair<int, int> levels_with(LampSpec const& lamp, LampSetting const& setting) {
    World world = testing::dark_world();
    world.lamps = {{.category = "lamp", .start_mm = {}, .setting = {}}};
    Lighting lighting({lamp}, world);
    lighting.update(world);
    world.lamps[0].setting = setting;
    lighting.update(world);
    return {world.light.at({505, 505}), world.light.at({205, 505})};
}

TEST(Lighting, LampOfEveryKindIsSwitchedDimmedAndMoved) {
    using Levels = std::pair<int, int>;
    SpotSpec orbiting = disk_lamp(1000);
    orbiting.orbit = {.radius_mm = 10.0F, .angular_speed_rad_s = 1.0, .phase_rad = 0.0};
    for (LampSpec const& lamp : {LampSpec(disk_lamp(1000)), LampSpec(orbiting)}) {
        EXPECT_EQ(levels_with(lamp, {}), (Levels{1000, 0}));
        EXPECT_EQ(levels_with(lamp, {.is_on = false, .moved_mm = {}}), (Levels{0, 0}));
        EXPECT_EQ(levels_with(lamp, {.intensity = 0.5F, .moved_mm = {}}), (Levels{500, 0}));
        EXPECT_EQ(levels_with(lamp, {.intensity = 100.0F, .moved_mm = {}}), (Levels{32767, 0}));
        EXPECT_EQ(levels_with(lamp, {.moved_mm = {-300, 0}}), (Levels{0, 1000}));
    }
    RotatingRaySpec ray;
    ray.shape.kind = ShapeKind::disk;
    ray.shape.radius_mm = 100.0F;
    ray.centre_mm = {505, 505};
    ray.half_width_rad = std::numbers::pi;
    ray.white_frame_duration_s = 0.0;
    ray.value = 1000;
    EXPECT_EQ(levels_with(ray, {}), (Levels{1000, 0}));
    EXPECT_EQ(levels_with(ray, {.is_on = false, .moved_mm = {}}), (Levels{0, 0}));
    EXPECT_EQ(levels_with(ray, {.intensity = 0.5F, .moved_mm = {}}), (Levels{500, 0}));
    EXPECT_EQ(levels_with(ray, {.moved_mm = {-300, 0}}), (Levels{0, 1000}));
}

TEST(Lighting, MapFollowsTheTime) {
    SpotSpec lamp = global_lamp(200);
    lamp.photo_start_at_s = 0.02F;
    lamp.photo_start_duration_s = 0.01F;
    World world = testing::dark_world();
    Lighting lighting({lamp}, world);
    std::vector<int> levels;
    for (world.step = 0; world.step < 5; ++world.step) {
        lighting.update(world);
        levels.push_back(world.light.at({500, 500}));
    }
    EXPECT_EQ(levels, (std::vector<int>{0, 0, 32767, 200, 200}));
}

TEST(Lighting, WithoutLampsItIsDark) {
    EXPECT_EQ(testing::count_cells(lit_world({}), 0), 10000);
}

TEST(Lighting, LevelsOutsideTheMapAreThoseOfTheNearestCell) {
    World const world = lit_world({disk_lamp(1000), global_lamp(7)});
    EXPECT_EQ(world.light.at({-50, 500}), 7);
    EXPECT_EQ(world.light.at({5000, 5000}), 7);
}

// ---- a map that is kept up to date is the one that is made anew ----

Shape random_shape(RandomStream& random) {
    constexpr std::array kinds{ShapeKind::disk,     ShapeKind::rectangle, ShapeKind::capsule,
                               ShapeKind::triangle, ShapeKind::global,    ShapeKind::arena};
    ShapeKind const kind = kinds[random.below(kinds.size())];
    auto const size = [&] { return 20.0F + static_cast<float>(random.below(600)); };
    return {.kind = kind, .radius_mm = size(), .width_mm = size(), .height_mm = size(), .side_length_mm = size()};
}

LampSpec random_lamp(RandomStream& random) {
    Shape const shape = random_shape(random);
    Vec2 const centre{static_cast<float>(random.below(1000)), static_cast<float>(random.below(1000))};
    int const value = static_cast<int>(random.below(20000));
    double const speed = 6.0 * random.uniform() - 3.0;
    switch (random.below(3)) {
        case 0: {
            RotatingRaySpec ray{{.shape = shape,
                                 .centre_mm = centre,
                                 .value = value,
                                 .half_width_rad = 0.01 + 3.0 * random.uniform(),
                                 .angular_speed_rad_s = speed}};
            ray.white_frame_duration_s = 0.1 * random.uniform();
            ray.photo_start_at_s = 4.0 * random.uniform() - 2.0;
            return ray;
        }
        case 1:
            return AlternatingRaysSpec{{.shape = shape,
                                        .centre_mm = centre,
                                        .value = value,
                                        .half_width_rad = 0.01 + 3.0 * random.uniform(),
                                        .angular_speed_rad_s = speed}};
        default: {
            SpotSpec spot;
            spot.shape = shape;
            spot.centre_mm = centre;
            spot.orbit = {.radius_mm = static_cast<float>(random.below(3)) * 200.0F, .angular_speed_rad_s = speed};
            spot.mode = static_cast<LightMode>(random.below(3));
            spot.value = value;
            spot.photo_start_at_s = static_cast<float>(4.0 * random.uniform() - 2.0);
            return spot;
        }
    }
}

TEST(Lighting, KeptUpToDateIsTheSameAsMadeAnewAtAnyTime) {
    RandomStream random(7, 0);
    for (int scene = 0; scene < 12; ++scene) {
        std::vector<LampSpec> lamps;
        for (int n = 0; n < 5; ++n) {
            lamps.push_back(random_lamp(random));
        }
        World world = testing::dark_world();
        Lighting lighting(lamps, world);
        for (int look = 0; look < 20; ++look) {
            // Mostly the next steps, now and then far ahead or back.
            world.step = random.below(4) == 0 ? random.below(2000) : world.step + random.below(3);
            lighting.update(world);
            ASSERT_EQ(world.light.level, lit_world(lamps, world.time_s()).light.level) << scene << ' ' << world.step;
        }
    }
}

TEST(Lighting, MapsNeedNotBeSquare) {
    World world = testing::square_world();
    world.light = make_light_map(world.arena, world.periodic, 7, 200);
    RotatingRaySpec ray;
    ray.shape.kind = ShapeKind::global;
    ray.half_width_rad = 0.3;
    ray.white_frame_duration_s = 0.0;
    Lighting({ray}, world).update(world);
    for (std::size_t cell = 0; cell < world.light.level.size(); ++cell) {
        double const x = (static_cast<double>(cell % 7) + 0.5) * 1000.0 / 7.0;
        double const y = (static_cast<double>(cell / 7) + 0.5) * 1000.0 / 200.0;
        ASSERT_EQ(world.light.level[cell], std::abs(std::atan2(y - 500.0, x - 500.0)) <= 0.3 ? 10 : 0) << cell;
    }
}

TEST(Lighting, MarkOfALampFollowsItsOrbit) {
    SpotSpec lamp = disk_lamp(1000);
    lamp.orbit = {.radius_mm = 100.0F, .angular_speed_rad_s = std::numbers::pi / 2.0, .phase_rad = 0.0};
    lamp.photo_start_at_s = 1.5F;  // a dark lamp moves, too
    World world = testing::dark_world();
    Lighting lighting({lamp}, world);
    for (auto const& [time_s, place] : {std::pair{0.0, Vec2{605, 505}}, {1.0, {505, 605}}, {2.0, {405, 505}}}) {
        world.step = std::lround(time_s / world.time_step_s);
        lighting.update(world);
        auto const marks = lighting.marks();
        ASSERT_EQ(marks.size(), 1U);
        EXPECT_NEAR(marks[0].centre_mm.x, place.x, 0.01F);
        EXPECT_NEAR(marks[0].centre_mm.y, place.y, 0.01F);
        EXPECT_EQ(marks[0].shape_mm, marks[0].centre_mm);
        EXPECT_EQ(marks[0].shape, lamp.shape);
        EXPECT_FALSE(marks[0].has_beam);
    }
}

TEST(Lighting, LightThatIsTheSameEverywhereHasNoMark) {
    World world = testing::dark_world();
    SpotSpec gradient = global_lamp(200);
    gradient.mode = LightMode::gradient;
    gradient.centre_mm = {300, 400};
    Lighting lighting({global_lamp(200), gradient}, world);
    lighting.update(world);
    auto const marks = lighting.marks();
    ASSERT_EQ(marks.size(), 1U);
    EXPECT_EQ(marks[0].centre_mm, (Vec2{300, 400}));
}

TEST(Lighting, LevelsWrittenByOthersHoldUntilALampWritesTheCell) {
    SpotSpec flash = global_lamp(200);
    flash.photo_start_at_s = 0.05F;
    World world = testing::dark_world();
    Lighting lighting({flash}, world);
    lighting.update(world);
    world.light.level[0] = 77;
    for (world.step = 1; world.step < 5; ++world.step) {
        lighting.update(world);
        EXPECT_EQ(world.light.level[0], 77);
    }
    lighting.update(world);
    EXPECT_NE(world.light.level[0], 77);
}

}  // namespace
}  // namespace pogosim
