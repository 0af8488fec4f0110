// Capsules, polygons, rounded corners, and bodies of several convex parts, in both engines.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "base/random.hpp"
#include "physics/body_mass.hpp"
#include "support/crowd_measures.hpp"
#include "support/each_engine.hpp"
#include "support/shapes.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_body;
using testing::BoxPart;
using testing::capsule;
using testing::compound;
using testing::deepest_overlap_mm;
using testing::deepest_when_all_push_mm;
using testing::disk;
using testing::energy;
using testing::extremes_in;
using testing::make_engine;
using testing::octagon;
using testing::polygon;
using testing::rectangle;
using testing::rounded;
using testing::square_world;
using testing::tray;
using testing::triangle;

constexpr float kPi = std::numbers::pi_v<float>;

class SolidShapes : public testing::EachEngine {
protected:
    bool is_ours() const { return GetParam() == "disk"; }
};

/// A ball of radius 20 mm that hits something at rest with 100 mm/s along +x, without friction: both velocities after
/// it, and the spin. `lever_mm`: of the point of contact, below the other's centre of mass; the normal is along x.
void expect_impact(Shape const& shape, float lever_mm, float restitution) {
    SCOPED_TRACE(::testing::Message() << "shape " << static_cast<int>(shape.kind) << ", lever " << lever_mm
                                      << " mm, restitution " << restitution);
    World world = square_world(2000.0F);
    world.time_step_s = 0.001;
    BodySpec const smooth{.friction = 0.0F, .restitution = restitution};
    std::uint32_t const hit = add_body(world, shape, {1000.0F, 1000.0F}, 0.0F, smooth);
    std::uint32_t const ball = add_body(world, disk(20.0F), {880.0F, 1000.0F + lever_mm}, 0.0F, smooth);
    world.bodies.velocity_mm_s[ball] = {100.0F, 0.0F};
    auto const engine = make_engine(world, {});
    for (int step = 0; step < 1500 && world.bodies.velocity_mm_s[hit] == Vec2{}; ++step) {
        engine->advance(world);
    }
    engine->advance(world);  // an impact may be spread over two steps
    ShapeMass const of_hit = mass_of(shape);
    ShapeMass const of_ball = mass_of(disk(20.0F));
    float const gyration_mm2 = of_hit.gyration_mm2;
    float const impulse = (1.0F + restitution) * 100.0F /
                          (1.0F / of_ball.area_mm2 + (1.0F + lever_mm * lever_mm / gyration_mm2) / of_hit.area_mm2);
    float const scale = impulse / of_hit.area_mm2;
    EXPECT_NEAR(world.bodies.velocity_mm_s[hit].x, scale, 0.01F * scale);
    EXPECT_NEAR(world.bodies.velocity_mm_s[ball].x, 100.0F - impulse / of_ball.area_mm2, 1.0F);
    EXPECT_NEAR(world.bodies.angular_velocity_rad_s[hit], -lever_mm * scale / gyration_mm2,
                0.01F * std::abs(lever_mm) * scale / gyration_mm2 + 1e-4F);
}

TEST_P(SolidShapes, ImpactsAreThoseOfTheClosedForm) {
    for (float const restitution : {0.0F, 0.5F, 1.0F}) {
        expect_impact(capsule(30.0F, 120.0F), 0.0F, restitution);
        expect_impact(capsule(30.0F, 120.0F), 35.0F, restitution);
        expect_impact(octagon(100.0F), 15.0F, restitution);
        expect_impact(rounded(rectangle(40.0F, 140.0F), 10.0F), -50.0F, restitution);
        expect_impact(polygon({{-20.0F, -50.0F}, {30.0F, -20.0F}, {30.0F, 20.0F}, {-20.0F, 50.0F}}, 4.0F), 25.0F,
                      restitution);
        // The back of a tray, in front of it and off its middle; then one of its sides from outside.
        expect_impact(tray(80.0F, 120.0F, 12.0F), 0.0F, restitution);
        expect_impact(tray(80.0F, 120.0F, 12.0F), 45.0F, restitution);
    }
}

TEST_P(SolidShapes, BallInsideATrayPushesItsBack) {
    World world = square_world(2000.0F);
    Shape const shape = tray(120.0F, 120.0F, 12.0F);
    std::uint32_t const pushed =
        add_body(world, shape, {1000.0F, 1000.0F}, 0.0F, {.friction = 0.0F, .restitution = 0.0F});
    std::uint32_t const ball =
        add_body(world, disk(20.0F), {1050.0F, 1000.0F}, 0.0F, {.friction = 0.0F, .restitution = 0.0F});
    auto const engine = make_engine(world, {});
    float deepest_mm = 0.0F;
    for (int step = 0; step < 500; ++step) {
        world.robots.command[ball] = {.velocity_mm_s = {-60.0F, 0.0F}, .pending = step % 2 == 0};
        engine->advance(world);
        deepest_mm = std::max(deepest_mm, deepest_overlap_mm(world));
    }
    EXPECT_LT(deepest_mm, is_ours() ? 0.1F : 1.0F);
    EXPECT_LT(world.bodies.position_mm[pushed].x, 900.0F);
    // It stands at the back wall, 12 + 20 mm from the outside.
    float const back_mm = bounding_box(shape).min.x + 32.0F;
    EXPECT_NEAR(world.bodies.position_mm[ball].x - world.bodies.position_mm[pushed].x, back_mm, 0.6F);
}

/// A frame of four bars around a ball.
Shape frame() {
    return compound({BoxPart{{0.0F, 0.0F}, {200.0F, 10.0F}}, BoxPart{{0.0F, 190.0F}, {200.0F, 10.0F}},
                     BoxPart{{0.0F, 10.0F}, {10.0F, 180.0F}}, BoxPart{{190.0F, 10.0F}, {10.0F, 180.0F}}});
}

TEST_P(SolidShapes, NothingLeavesAFrame) {
    for (bool const is_fixed : {false, true}) {
        for (float const speed_mm_s : {100.0F, 700.0F, 5000.0F, 15000.0F}) {
            if (!is_ours() && speed_mm_s > 700.0F) {
                continue;  // Box2D puts what jumps a bar on its other side
            }
            for (Shape const& shape : {disk(15.0F), capsule(50.0F, 20.0F), octagon(30.0F), tray(40.0F, 40.0F, 6.0F)}) {
                World world = square_world(3000.0F);
                BodySpec const elastic{.restitution = 1.0F, .fixed = is_fixed};
                std::uint32_t const ring = add_body(world, frame(), {1500.0F, 1500.0F}, 0.0F, elastic);
                std::uint32_t const prisoner = add_body(world, shape, {1490.0F, 1503.0F}, 0.4F, {.restitution = 1.0F});
                world.bodies.velocity_mm_s[prisoner] = speed_mm_s * direction(0.7F);
                auto const engine = make_engine(world, {});
                for (int step = 0; step < 400; ++step) {
                    engine->advance(world);
                    Vec2 const from_ring_mm = world.bodies.position_mm[prisoner] - world.bodies.position_mm[ring];
                    Vec2 const axis = world.bodies.heading_dir[ring];
                    Vec2 const place_mm{dot(from_ring_mm, axis), dot(from_ring_mm, Vec2{-axis.y, axis.x})};
                    ASSERT_LT(std::max(std::abs(place_mm.x), std::abs(place_mm.y)), 91.0F)
                        << speed_mm_s << " mm/s, step " << step << ", shape " << static_cast<int>(shape.kind)
                        << (is_fixed ? ", fixed" : "");
                }
            }
        }
    }
}

/// Rows of capsules, octagons and pairs of angles that interlock, each row filling this share of its area.
World packed(float coverage, BodySpec const& body) {
    constexpr float width_mm = 700.0F;
    World world = square_world(width_mm);
    float y_mm = 0.0F;
    auto const fill_row = [&](Vec2 cell_mm, float filled_mm2, auto const& fill) {
        float const scale = std::sqrt(filled_mm2 / (cell_mm.x * cell_mm.y) / coverage);
        auto const columns = static_cast<int>(width_mm / (scale * cell_mm.x));
        float const lane_mm = width_mm / static_cast<float>(columns);
        float const height_mm = filled_mm2 / coverage / lane_mm;
        for (int i = 0; i < columns; ++i) {
            fill(Vec2{lane_mm * (static_cast<float>(i) + 0.5F), y_mm + 0.5F * height_mm}, scale);
        }
        y_mm += height_mm;
    };
    Shape const angle = compound({{{-30.0F, 0.0F}, {40.0F, 20.0F}}, {{-30.0F, -20.0F}, {20.0F, 20.0F}}});
    // From the middle of the cell of 60 mm x 40 mm to the centre of mass of its lower angle.
    Vec2 const offset_mm{(800.0F * -10.0F + 400.0F * -20.0F) / 1200.0F, (800.0F * 10.0F - 400.0F * 10.0F) / 1200.0F};
    for (int row = 0; row < 3; ++row) {
        fill_row({60.0F, 20.0F}, 800.0F + kPi * 100.0F,
                 [&](Vec2 at_mm, float) { add_body(world, capsule(60.0F, 20.0F), at_mm, 0.0F, body); });
        fill_row({40.0F, 40.0F}, mass_of(octagon(40.0F)).area_mm2,
                 [&](Vec2 at_mm, float) { add_body(world, octagon(40.0F), at_mm, 0.0F, body); });
        fill_row({60.0F, 40.0F}, 2400.0F, [&](Vec2 at_mm, float scale) {
            add_body(world, angle, at_mm + scale * offset_mm, 0.0F, body);
            add_body(world, angle, at_mm - scale * offset_mm, kPi, body);
        });
        fill_row({50.0F, 30.0F}, mass_of(rounded(rectangle(50.0F, 30.0F), 5.0F)).area_mm2, [&](Vec2 at_mm, float) {
            add_body(world, rounded(rectangle(50.0F, 30.0F), 5.0F), at_mm, 0.0F, body);
        });
    }
    world.arena = make_arena({{{0, 0}, {width_mm, 0}, {width_mm, y_mm}, {0, y_mm}}});
    return world;
}

TEST_P(SolidShapes, DensePackingDoesNotOverlapNorGainEnergy) {
    for (float const restitution : {0.0F, 1.0F}) {
        World world = packed(0.8F, {.friction = 0.1F, .restitution = restitution});
        ASSERT_LT(deepest_overlap_mm(world), 0.06F);
        RandomStream random(1, 0);
        for (Vec2& velocity : world.bodies.velocity_mm_s) {
            velocity = 60.0F * direction(random.uniform(-kPi, kPi));
        }
        auto const engine = make_engine(world, {.friction = 0.1F, .restitution = restitution});
        double const before = energy(world);
        auto const [highest, deepest_mm] = extremes_in(world, *engine, 250);
        EXPECT_LT(deepest_mm, is_ours() ? 0.5F : 3.0F) << restitution;
        EXPECT_LT(highest, (is_ours() ? 1.001 : 1.05) * before) << restitution;
    }
}

TEST_P(SolidShapes, PackingThatAllPushToOneSideStaysApart) {
    World world = packed(0.8F, {.restitution = 0.2F});
    auto const engine = make_engine(world, {});
    float const deepest_mm = deepest_when_all_push_mm(world, *engine, {50.0F, 20.0F}, 250);
    EXPECT_LT(deepest_mm, is_ours() ? 0.5F : 6.0F);
}

TEST_P(SolidShapes, CapsulesRollOverTheEndsOfEachOther) {
    // End to end they touch at their length, whatever the offset of the ends: the distance of the ends' centres is 20.
    for (float const offset_mm : {0.0F, 5.0F, 12.0F}) {
        World world = square_world(2000.0F);
        BodySpec const body{.density = 1e4F, .friction = 0.0F, .restitution = 0.0F};
        std::uint32_t const one = add_body(world, capsule(80.0F, 20.0F), {900.0F, 1000.0F}, 0.0F, body);
        std::uint32_t const other = add_body(world, capsule(80.0F, 20.0F), {1000.0F, 1000.0F + offset_mm}, 0.0F,
                                             {.density = 1e4F, .restitution = 0.0F, .fixed = true});
        world.bodies.velocity_mm_s[one] = {30.0F, 0.0F};
        auto const engine = make_engine(world, {});
        float nearest_mm = 100.0F;
        for (int step = 0; step < 200; ++step) {
            engine->advance(world);
            nearest_mm = std::min(nearest_mm, testing::gap_mm(world, one, other));
        }
        EXPECT_NEAR(nearest_mm, 0.0F, is_ours() ? 0.1F : 0.55F) << offset_mm;
        if (offset_mm == 0.0F) {
            EXPECT_NEAR(world.bodies.position_mm[one].x, 920.0F, 0.5F);
        } else {
            EXPECT_LT(world.bodies.position_mm[one].y, 1000.0F) << offset_mm;  // pushed off
        }
    }
}

/// A ball hits an arm of a tray: the same everywhere in a periodic world.
TEST(Compound, TouchesAcrossTheSeam) {
    std::vector<Vec2> velocities_mm_s;
    std::vector<float> spins_rad_s;
    for (float const x_mm : {500.0F, 990.0F, 1005.0F}) {
        World world = square_world(1000.0F);
        world.periodic = true;
        std::uint32_t const pushed =
            add_body(world, tray(100.0F, 160.0F, 10.0F), {std::fmod(x_mm, 1000.0F), 30.0F}, kPi, {});
        std::uint32_t const ball = add_body(world, disk(20.0F), {x_mm - 140.0F, 962.0F}, 0.0F);
        world.bodies.velocity_mm_s[ball] = {100.0F, 0.0F};
        auto const engine = make_physics_engine("disk", world, {}, testing::one_worker());
        for (int step = 0; step < 150; ++step) {
            engine->advance(world);
        }
        velocities_mm_s.push_back(world.bodies.velocity_mm_s[pushed]);
        spins_rad_s.push_back(world.bodies.angular_velocity_rad_s[pushed]);
    }
    EXPECT_GT(velocities_mm_s[0].x, 1.0F);
    EXPECT_GT(std::abs(spins_rad_s[0]), 0.02F);
    for (std::size_t i = 1; i < velocities_mm_s.size(); ++i) {
        EXPECT_NEAR(velocities_mm_s[i].x, velocities_mm_s[0].x, 0.1F);
        EXPECT_NEAR(velocities_mm_s[i].y, velocities_mm_s[0].y, 0.1F);
        EXPECT_NEAR(spins_rad_s[i], spins_rad_s[0], 0.01F);
    }
}

/// One convex body and the same cut in two along its middle move alike.
TEST(Compound, OfTwoHalvesMovesAsTheWhole) {
    Shape const halves = compound({{{-40.0F, -20.0F}, {40.0F, 40.0F}}, {{0.0F, -20.0F}, {40.0F, 40.0F}}});
    std::vector<Vec2> places_mm;
    std::vector<float> headings_rad;
    for (Shape const& shape : {rectangle(80.0F, 40.0F), halves}) {
        World world = square_world(1000.0F);
        std::uint32_t const box =
            add_body(world, shape, {500.0F, 500.0F}, 0.3F, {.friction = 0.0F, .restitution = 0.5F});
        std::uint32_t const ball =
            add_body(world, disk(26.5F), {400.0F, 480.0F}, 0.0F, {.friction = 0.0F, .restitution = 0.5F});
        world.bodies.velocity_mm_s[ball] = {100.0F, 0.0F};
        auto const engine = make_physics_engine("disk", world, {}, testing::one_worker());
        for (int step = 0; step < 200; ++step) {
            engine->advance(world);
        }
        places_mm.push_back(world.bodies.position_mm[box]);
        headings_rad.push_back(world.bodies.heading_rad[box]);
    }
    EXPECT_GT(length(places_mm[0] - Vec2{500.0F, 500.0F}), 20.0F);
    EXPECT_NEAR(places_mm[1].x, places_mm[0].x, 0.05F);
    EXPECT_NEAR(places_mm[1].y, places_mm[0].y, 0.05F);
    EXPECT_NEAR(headings_rad[1], headings_rad[0], 0.002F);
}

TEST_P(SolidShapes, AreHeldByWalls) {
    for (Shape const& shape :
         {capsule(60.0F, 20.0F), octagon(40.0F), tray(60.0F, 60.0F, 8.0F), rounded(triangle(60.0F), 6.0F),
          polygon({{-30.0F, 0.0F}, {25.0F, -2.0F}, {25.0F, 2.0F}})}) {
        for (float const speed_mm_s : {60.0F, 3000.0F}) {
            World world = square_world(400.0F);
            std::uint32_t const body = add_body(world, shape, {200.0F, 200.0F}, 0.2F, {.restitution = 0.6F});
            world.bodies.angular_velocity_rad_s[body] = 3.0F;
            world.bodies.velocity_mm_s[body] = speed_mm_s * direction(0.9F);
            auto const engine = make_engine(world, {.friction = 0.3F, .restitution = 0.6F});
            float deepest_mm = 0.0F;
            for (int step = 0; step < 600; ++step) {
                engine->advance(world);
                Vec2 const place_mm = world.bodies.position_mm[body];
                ASSERT_TRUE(place_mm.x > 0.0F && place_mm.x < 400.0F && place_mm.y > 0.0F && place_mm.y < 400.0F);
                deepest_mm = step > 500 ? std::max(deepest_mm, deepest_overlap_mm(world)) : 0.0F;
            }
            EXPECT_LT(deepest_mm, is_ours() ? 0.5F : 2.0F) << static_cast<int>(shape.kind) << ", " << speed_mm_s;
        }
    }
}

POGOSIM_FOR_EACH_ENGINE(SolidShapes);

}  // namespace
}  // namespace pogosim
