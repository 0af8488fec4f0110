// Bodies of all shapes against narrow pieces of wall: a pillar of the arena is to them what a fixed body is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "base/random.hpp"
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
using testing::energy;
using testing::rectangle;
using testing::square_world;
using testing::tray;
using testing::triangle;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr Vec2 kMiddle{510.0F, 510.0F};

/// Where a small thing stands in the middle of the square.
struct Obstacle {
    std::string name;
    Polygon line;
    // That a body may sink into it; the inner corner of a tray sinks deeper into an end of a thin wall.
    float deepest_mm;
};

float depth_mm(World const& world, std::uint32_t body, Polygon const& line) {
    Hull const wall = hull_of({line, 0.0F});
    float deepest_mm = 0.0F;
    Bodies const& bodies = world.bodies;
    for (Hull const& part : testing::hulls_at(bodies.shape[body], bodies.position_mm[body], bodies.heading_rad[body])) {
        deepest_mm = std::max(deepest_mm, -gap_between_mm(part, wall));
    }
    return deepest_mm;
}

TEST(Pillar, NeitherThrowsBodiesNorLetsThemIn) {
    std::vector<Obstacle> const obstacles{
        {"pillar", {{500.0F, 500.0F}, {520.0F, 500.0F}, {520.0F, 520.0F}, {500.0F, 520.0F}}, 0.5F},
        {"thin wall", {{509.0F, 440.0F}, {511.0F, 440.0F}, {511.0F, 580.0F}, {509.0F, 580.0F}}, 2.0F}};
    std::vector<Shape> const shapes{
        tray(160.0F, 160.0F, 10.0F),
        compound({BoxPart{{0.0F, 0.0F}, {160.0F, 10.0F}}, BoxPart{{0.0F, 10.0F}, {10.0F, 150.0F}}}),
        rectangle(200.0F, 10.0F), capsule(120.0F, 24.0F), triangle(150.0F)};
    RandomStream random(9, 0);
    int met = 0;
    for (Obstacle const& obstacle : obstacles) {
        for (Shape const& shape : shapes) {
            for (int run = 0; run < 30; ++run) {
                World world = square_world(1000.0F);
                world.arena = make_arena({{{0, 0}, {1000, 0}, {1000, 1000}, {0, 1000}}, obstacle.line});
                Vec2 const from_mm{random.uniform(200.0F, 330.0F), random.uniform(350.0F, 650.0F)};
                std::uint32_t const body =
                    add_body(world, shape, from_mm, random.uniform(-kPi, kPi), {.restitution = 0.0F});
                Vec2 const to_mm = kMiddle + Vec2{random.uniform(-90.0F, 90.0F), random.uniform(-90.0F, 90.0F)};
                Vec2 const way_mm = to_mm - from_mm;
                world.bodies.velocity_mm_s[body] = (60.0F / length(way_mm)) * way_mm;
                world.bodies.angular_velocity_rad_s[body] = random.uniform(-1.5F, 1.5F);
                Vec2 const velocity_mm_s = world.bodies.velocity_mm_s[body];
                auto const engine = make_physics_engine("disk", world, {.restitution = 0.0F}, testing::one_worker());
                double const before = energy(world);
                double highest = before;
                float deepest_mm = 0.0F;
                for (int step = 0; step < 700; ++step) {
                    engine->advance(world);
                    highest = std::max(highest, energy(world));
                    deepest_mm = std::max(deepest_mm, depth_mm(world, body, obstacle.line));
                }
                EXPECT_LT(highest, 1.01 * before)
                    << obstacle.name << ", " << static_cast<int>(shape.kind) << ", " << run;
                EXPECT_LT(deepest_mm, obstacle.deepest_mm)
                    << obstacle.name << ", " << static_cast<int>(shape.kind) << ", " << run;
                met += world.bodies.velocity_mm_s[body] != velocity_mm_s ? 1 : 0;
            }
        }
    }
    EXPECT_GT(met, 150);
}

}  // namespace
}  // namespace pogosim
