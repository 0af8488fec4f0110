// Lamps that cast shadows: what bodies and walls hide on the light map.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "base/random.hpp"
#include "light/light_blockers.hpp"
#include "lit_world.hpp"
#include "support/shapes.hpp"

namespace pogosim {
namespace {

using testing::add_body;
using testing::dark_world;
using testing::disk;
using testing::disk_lamp;
using testing::rectangle;

constexpr int kLevel = 1000;

/// A lamp at this place that lights the whole map.
SpotSpec wide_lamp(Vec2 centre_mm) {
    SpotSpec lamp;
    lamp.shape = disk(5000.0F);
    lamp.centre_mm = centre_mm;
    lamp.value = kLevel;
    return lamp;
}

LampSpec casting(LampSpec lamp) {
    lamp.casts_shadows = true;
    return lamp;
}

std::uint32_t add_object(World& world, Shape const& shape, Vec2 position_mm, float heading_rad = 0.0F) {
    ObjectSpec spec;
    spec.shape = shape;
    spec.body = BodySpec{};
    return add_body(world, position_mm, heading_rad, spec);
}

void light(World& world, std::vector<LampSpec> const& lamps) {
    Lighting(lamps, world).update(world);
}

struct Exact {
    double x;
    double y;
};

double cross(Exact a, Exact b) {
    return a.x * b.y - a.y * b.x;
}

Exact between(Vec2 a, Vec2 b) {
    return {static_cast<double>(b.x) - static_cast<double>(a.x), static_cast<double>(b.y) - static_cast<double>(a.y)};
}

/// How often the straight line between two points crosses a closed line.
int crossings(Vec2 from, Vec2 to, Polygon const& polygon) {
    int count = 0;
    Vec2 a = polygon.back();
    for (Vec2 const b : polygon) {
        bool const ends_apart =
            (cross(between(from, to), between(from, a)) > 0.0) != (cross(between(from, to), between(from, b)) > 0.0);
        bool const line_apart =
            (cross(between(a, b), between(a, from)) > 0.0) != (cross(between(a, b), between(a, to)) > 0.0);
        count += ends_apart && line_apart ? 1 : 0;
        a = b;
    }
    return count;
}

/// Whether the straight line has entered a part of the body and left it again, and its end is in none.
bool passes_through(World const& world, std::uint32_t body, Vec2 from, Vec2 to) {
    int count = 0;
    for (Polygon const& own : outlines(world.bodies.shape[body], 32)) {
        Polygon const part = moved(own, world.bodies.position_mm[body], world.bodies.heading_rad[body]);
        if (contains(part, from) || contains(part, to)) {
            return false;
        }
        count += crossings(from, to, part);
    }
    return count >= 2;
}

TEST(Shadows, DiskHidesTheConeBehindItAndNoMore) {
    Vec2 const source{203.3F, 498.1F};
    Vec2 const middle{421.7F, 530.9F};
    constexpr double kRadius = 40.0;
    constexpr double kEdgeMm = 1e-3;
    World world = dark_world();
    add_object(world, disk(static_cast<float>(kRadius)), middle);
    light(world, {casting(wide_lamp(source))});
    double const distance = std::hypot(middle.x - source.x, middle.y - source.y);
    double const half_angle = std::asin(kRadius / distance);
    double const tangent = std::sqrt(distance * distance - kRadius * kRadius);
    int hidden = 0;
    testing::for_each_cell(world, [&](int level, Vec2 cell) {
        double const off = testing::angle_between(testing::bearing(source, cell), testing::bearing(source, middle));
        double const away = std::hypot(cell.x - source.x, cell.y - source.y);
        double const from_middle = std::hypot(cell.x - middle.x, cell.y - middle.y);
        if (std::abs(off - half_angle) * away < kEdgeMm || std::abs(from_middle - kRadius) < kEdgeMm) {
            return;
        }
        bool const is_behind = off < half_angle && from_middle > kRadius && away > tangent;
        EXPECT_EQ(level, is_behind ? 0 : kLevel) << cell.x << ", " << cell.y;
        hidden += level == 0 ? 1 : 0;
    });
    // Area of the cone up to the wall, 796.7 mm from the lamp, about: the opening is 2 x 0.182 rad.
    EXPECT_GT(hidden, 500);
    EXPECT_LT(hidden, 2000);
}

TEST(Shadows, HalfWidthBehindADiskIsThatOfTheUmbraOfAPoint) {
    // Straight to the right: at a distance x, half a width of x tan(asin(r / d)).
    World world = dark_world();
    add_object(world, disk(50.0F), {300, 500});
    light(world, {casting(wide_lamp({100, 500}))});
    double const slope = std::tan(std::asin(50.0 / 200.0));
    for (float x = 405; x < 1000; x += 10) {
        int dark = 0;
        for (float y = 5; y < 1000; y += 10) {
            dark += world.light.at({x, y}) == 0 ? 1 : 0;
        }
        EXPECT_NEAR(dark, 2.0 * (x - 100.0) * slope / 10.0, 1.01) << x;
    }
}

TEST(Shadows, BodiesOfAllShapesHideWhatTheLineOfSightPasses) {
    RandomStream random(1, 7);
    std::array const shapes{disk(60.0F),
                            rectangle(150.0F, 30.0F),
                            testing::triangle(140.0F),
                            testing::capsule(150.0F, 40.0F),
                            testing::octagon(100.0F),
                            testing::rounded(rectangle(120.0F, 80.0F), 25.0F),
                            testing::tray(120.0F, 160.0F, 25.0F)};
    auto const any = [&](float from, float to) { return from + (to - from) * random.uniform(); };
    for (int round = 0; round < 30; ++round) {
        World world = dark_world();
        Vec2 const source{any(-100, 1100), any(-100, 1100)};
        std::vector<std::uint32_t> bodies;
        for (Shape const& shape : shapes) {
            bodies.push_back(add_object(world, shape, {any(50, 950), any(50, 950)}, any(-3, 3)));
        }
        world.walls_block_light = false;
        light(world, {casting(wide_lamp(source))});
        int wrong = 0;
        testing::for_each_cell(world, [&](int level, Vec2 cell) {
            bool is_hidden = false;
            for (std::uint32_t const body : bodies) {
                if (world.bodies.shape[body].kind == ShapeKind::disk) {
                    Vec2 const middle = world.bodies.position_mm[body];
                    bool const passes = length(nearest_on_segment(source, cell, middle) - middle) < 60.0F;
                    is_hidden =
                        is_hidden || (passes && length(cell - middle) >= 60.0F && length(source - middle) > 60.0F);
                } else {
                    is_hidden = is_hidden || passes_through(world, body, source, cell);
                }
            }
            wrong += level != (is_hidden ? 0 : kLevel) ? 1 : 0;
        });
        EXPECT_LE(wrong, 1) << round;  // on the very edge of a disk's shadow
    }
}

TEST(Shadows, WallsHideWhatIsBehindThemFromAnyPlaceOfTheLamp) {
    // An arena in the shape of an L, with a wall of its own.
    Polygon const l_shape{{0, 0}, {1000, 0}, {1000, 400}, {410, 400}, {410, 1000}, {0, 1000}};
    Polygon const pillar{{201, 301}, {299, 305}, {250, 390}};
    for (Vec2 const source : {Vec2{101, 903}, Vec2{851, 203}, Vec2{0, 1000}, Vec2{1000, 0}, Vec2{1000, 1000},
                              Vec2{-50, 203}, Vec2{251, 351}}) {
        World world = dark_world();
        world.arena.polygons = {l_shape, pillar};
        light(world, {casting(wide_lamp(source))});
        bool const is_outside = !world.arena.contains(source);
        int wrong = 0;
        int hidden = 0;
        testing::for_each_cell(world, [&](int level, Vec2 cell) {
            if (!world.arena.contains(cell)) {
                return;
            }
            // From just beside the lamp, so that one in a corner of the arena is in it.
            Vec2 const from = source + (1e-4F) * (cell - source);
            int const count = crossings(from, cell, l_shape) + crossings(from, cell, pillar);
            bool const is_hidden = count > (is_outside && count % 2 == 1 ? 1 : 0);
            wrong += level != (is_hidden ? 0 : kLevel) ? 1 : 0;
            hidden += is_hidden ? 1 : 0;
        });
        EXPECT_EQ(wrong, 0) << source.x << ", " << source.y;
        EXPECT_EQ(hidden > 50, source != (Vec2{251, 351}))
            << source.x << ", " << source.y;  // all is seen from the pillar
        world.walls_block_light = false;
        light(world, {casting(wide_lamp(source))});
        EXPECT_EQ(testing::count_cells(world, 0), 0);
    }
}

TEST(Shadows, NothingIsHiddenInASquareFromItsCornersAndBorders) {
    for (Vec2 const source : {Vec2{0, 0}, Vec2{1000, 0}, Vec2{0, 1000}, Vec2{1000, 1000}, Vec2{500, 0}, Vec2{0, 333},
                              Vec2{1e-5F, 1e-5F}, Vec2{999.9999F, 400}, Vec2{500, 1000.001F}}) {
        World world = dark_world();
        light(world, {casting(wide_lamp(source))});
        EXPECT_EQ(testing::count_cells(world, 0), 0) << source.x << ", " << source.y;
    }
}

TEST(Shadows, BodyAroundTheLampHidesNothing) {
    for (Shape const& shape : {disk(60.0F), rectangle(80.0F, 80.0F)}) {
        World world = dark_world();
        add_object(world, shape, {500, 500}, 0.3F);
        light(world, {casting(wide_lamp({503, 491}))});
        EXPECT_EQ(testing::count_cells(world, 0), 0);
    }
}

TEST(Shadows, MembraneIsDarkBehindItsLine) {
    World world = dark_world();
    testing::add_ring(world, {.centre_mm = {500, 500}, .radius_mm = 203.0F});
    light(world, {casting(wide_lamp({481, 523}))});
    int wrong = 0;
    testing::for_each_cell(world, [&](int level, Vec2 cell) {
        float const away = length(cell - Vec2{500, 500});
        wrong += std::abs(away - 203.0F) > 1.0F && level != (away < 203.0F ? kLevel : 0) ? 1 : 0;
    });
    EXPECT_EQ(wrong, 0);
}

TEST(Shadows, LightGoesOnAcrossTheBordersOfAPeriodicArenaAndSoDoShadows) {
    auto const levels = [](Vec2 moved_mm) {
        World world = testing::square_world();
        world.periodic = true;
        world.light = make_light_map(world.arena, true, 100, 100);
        auto const at = [&](Vec2 place_mm) { return wrapped(world, place_mm + moved_mm); };
        add_object(world, disk(43.0F), at({601.3F, 523.7F}));
        add_object(world, rectangle(30.0F, 200.0F), at({322.1F, 611.9F}), 0.4F);
        add_object(world, disk(20.0F), at({903.1F, 998.3F}));
        light(world, {casting(wide_lamp(at({502.3F, 498.9F})))});
        return world;
    };
    World const still = levels({});
    EXPECT_GT(testing::count_cells(still, 0), 1000);
    for (Vec2 const moved_mm : {Vec2{440, 0}, Vec2{0, -310}, Vec2{500, 500}, Vec2{-170, 730}}) {
        World const other = levels(moved_mm);
        int wrong = 0;
        testing::for_each_cell(still, [&](int level, Vec2 cell) {
            wrong += level != other.light.at(wrapped(other, cell + moved_mm)) ? 1 : 0;
        });
        EXPECT_LE(wrong, 4) << moved_mm.x << ", " << moved_mm.y;  // cells whose images are equally near
    }
}

TEST(Shadows, OfOneLampKeepTheLightOfTheOthers) {
    World world = dark_world();
    add_object(world, disk(40.0F), {500, 500});
    RotatingRaySpec ray;
    ray.shape.kind = ShapeKind::global;
    ray.centre_mm = {-300, 0};  // from the centre of the arena
    ray.value = 7000;
    ray.half_width_rad = 3.0;
    ray.white_frame_duration_s = 0.0;
    SpotSpec open = wide_lamp({500, 900});
    open.value = 30;
    light(world, {casting(wide_lamp({200, 500})), open, casting(ray)});
    EXPECT_EQ(world.light.at({305, 505}), 7000);
    EXPECT_EQ(world.light.at({705, 505}), 30);  // both are hidden
    EXPECT_EQ(world.light.at({505, 305}), 7000);
    EXPECT_EQ(world.light.at({505, 505}), 7000) << "in the body";
}

TEST(Shadows, WithoutTheKeyThereAreNone) {
    World world = dark_world();
    add_object(world, disk(40.0F), {500, 500});
    light(world, {wide_lamp({200, 500})});
    EXPECT_EQ(testing::count_cells(world, kLevel), 10000);
}

TEST(Shadows, BodyThatDoesNotBlockLightThrowsNone) {
    World world = dark_world();
    std::uint32_t const body = add_object(world, disk(40.0F), {500, 500});
    world.bodies.spec[body].blocks_light = false;
    light(world, {casting(wide_lamp({200, 500}))});
    EXPECT_EQ(testing::count_cells(world, kLevel), 10000);
}

TEST(Shadows, FollowTheBodiesAndTheLamp) {
    SpotSpec orbiting = wide_lamp({500, 500});
    orbiting.orbit = {.radius_mm = 300.0F, .angular_speed_rad_s = 1.0};
    SpotSpec gradient = wide_lamp({211, 300});
    gradient.mode = LightMode::gradient;
    AlternatingRaysSpec rays;
    rays.shape.kind = ShapeKind::global;
    rays.long_white_frame_duration_s = 0.1;
    std::vector<LampSpec> const lamps{casting(gradient), disk_lamp(50), casting(orbiting), casting(rays)};
    World world = dark_world();
    world.lamps.resize(lamps.size());
    add_object(world, disk(40.0F), {500, 500});
    add_object(world, rectangle(100.0F, 20.0F), {700, 300});
    Lighting lighting(lamps, world);
    for (int step = 0; step < 60; ++step) {
        world.step = 4 * step;
        if (step % 3 == 0) {
            world.bodies.position_mm[step / 3 % 2] = world.bodies.position_mm[step / 3 % 2] + Vec2{3.0F, 5.0F};
        }
        if (step == 20) {
            world.lamps[0].setting.moved_mm = {100, 40};
        }
        world.lamps[2].setting.is_on = step < 40;
        lighting.update(world);
        World fresh = world;
        std::ranges::fill(fresh.light.level, std::int16_t{0});
        light(fresh, lamps);
        ASSERT_EQ(world.light.level, fresh.light.level) << step;
        Lighting copy = lighting;
        World same = world;
        copy.update(same);
        ASSERT_EQ(world.light.level, same.light.level) << step;
    }
}

TEST(Shadows, RobotsNeverStandInTheirOwn) {
    RandomStream random(1, 3);
    auto const any = [&](float from, float to) { return from + (to - from) * random.uniform(); };
    for (ShapeKind const kind : {ShapeKind::disk, ShapeKind::rectangle}) {
        for (int round = 0; round < 200; ++round) {
            World world = dark_world();
            ObjectSpec spec = testing::pogobot_spec();
            spec.shape = kind == ShapeKind::disk ? disk(26.5F) : rectangle(50.0F, 30.0F);
            Vec2 const place{any(100, 900), any(100, 900)};
            float const heading = any(-3, 3);
            testing::add_robot(world, place, heading, spec);
            light(world, {casting(wide_lamp({any(0, 1000), any(0, 1000)}))});
            for (int i = 0; i < 40; ++i) {
                // A point in the body, where a sensor may be.
                Vec2 const offset{any(-25, 25), any(-15, 15)};
                if (contains(spec.shape, offset)) {
                    EXPECT_EQ(world.light.at(place + rotate(offset, direction(heading))), kLevel);
                }
            }
        }
    }
}

}  // namespace
}  // namespace pogosim
