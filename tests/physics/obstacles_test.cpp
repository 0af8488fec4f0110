// Disks among fixed rectangles and triangles.
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "geometry/polygon.hpp"
#include "physics/hulls.hpp"
#include "physics/physics_engine.hpp"
#include "support/each_engine.hpp"
#include "support/shapes.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::make_engine;
using testing::rectangle;
using testing::triangle;

constexpr float kRadiusMm = 26.5F;

ObjectSpec disk(float restitution = 0.5F, float friction = 0.0F) {
    ObjectSpec spec = testing::pogobot_spec();
    spec.body = BodySpec{.friction = friction, .restitution = restitution};
    return spec;
}

std::uint32_t add_disk(World& world, Vec2 place_mm, Vec2 velocity_mm_s, ObjectSpec const& spec = disk()) {
    std::uint32_t const robot = testing::add_robot(world, place_mm, 0.0F, spec);
    std::uint32_t const body = world.robots.body[robot];
    world.bodies.velocity_mm_s[body] = velocity_mm_s;
    return body;
}

/// Obstacles come after all robots.
std::uint32_t add_obstacle(World& world, Vec2 place_mm, float heading_rad, Shape const& shape) {
    ObjectSpec spec;
    spec.shape = shape;
    spec.body = BodySpec{.friction = 0.0F, .restitution = 0.5F, .fixed = true};
    std::uint32_t const body = testing::add_body(world, place_mm, heading_rad, spec);
    world.objects.push_back({.id = static_cast<std::uint32_t>(world.objects.size()), .body = body, .body_count = 1});
    return body;
}

Polygon outline_of(World const& world, std::uint32_t body) {
    return moved(outline(world.bodies.shape[body]), world.bodies.position_mm[body], world.bodies.heading_rad[body]);
}

/// From an obstacle to a point, negative inside.
float signed_distance(World const& world, std::uint32_t obstacle, Vec2 point_mm) {
    Polygon const corners = outline_of(world, obstacle);
    return distance_to_outline(corners, point_mm) * (contains(corners, point_mm) ? -1.0F : 1.0F);
}

class Obstacles : public testing::EachEngine {
protected:
    static void run(World& world, int steps) {
        auto const engine = make_engine(world, {});
        for (int step = 0; step < steps; ++step) {
            engine->advance(world);
        }
    }
};

TEST(Hulls, AreAsFarAsTheirOutlinesFromEveryPoint) {
    World world = testing::square_world();
    std::uint32_t const bar = add_obstacle(world, {300, 400}, 0.7F, rectangle(200, 30));
    std::uint32_t const wedge = add_obstacle(world, {700, 500}, -2.0F, triangle(150));
    Hulls const polygons(world);
    RandomStream random(7, 0);
    for (int i = 0; i < 2000; ++i) {
        std::uint32_t const body = i % 2 == 0 ? bar : wedge;
        Vec2 const point_mm =
            world.bodies.position_mm[body] + Vec2{random.uniform(-150.0F, 150.0F), random.uniform(-150.0F, 150.0F)};
        Gap const gap = polygons.gap_to(world, body, 0, point_mm);
        EXPECT_NEAR(gap.distance_mm, signed_distance(world, body, point_mm), 1e-3F);
        EXPECT_NEAR(length(gap.normal), 1.0F, 1e-5F);
        // The normal leads to the outline and away from it.
        EXPECT_NEAR(signed_distance(world, body, point_mm - gap.distance_mm * gap.normal), 0.0F, 1e-2F);
    }
}

TEST_P(Obstacles, ThrowDisksBackFromTheirSidesByTheLawOfRestitution) {
    World world = testing::square_world();
    std::uint32_t const robot = add_disk(world, {500, 300}, {40, 100});
    add_obstacle(world, {500, 500}, 0.0F, rectangle(400, 60));
    run(world, 250);  // 143.5 mm there
    EXPECT_NEAR(world.bodies.velocity_mm_s[robot].x, 40.0F, 0.5F);
    EXPECT_NEAR(world.bodies.velocity_mm_s[robot].y, -50.0F, 0.5F);
}

TEST_P(Obstacles, ThrowDisksBackFromTheirCorners) {
    World world = testing::square_world();
    // Onto the corner at (600, 530), half a radius off: at the impact, the normal is 30 degrees off the velocity.
    std::uint32_t const robot = add_disk(world, {600.0F + 0.5F * kRadiusMm, 800}, {0, -100}, disk(1.0F));
    add_obstacle(world, {500, 500}, 0.0F, rectangle(200, 60));
    run(world, 350);
    EXPECT_NEAR(world.bodies.velocity_mm_s[robot].x, 100.0F * std::sin(1.0471976F), 3.0F);
    EXPECT_NEAR(world.bodies.velocity_mm_s[robot].y, 100.0F * std::cos(1.0471976F), 3.0F);
}

TEST_P(Obstacles, StopDisksThatWouldJumpOverThemInAStep) {
    for (float const speed_mm_s : {3000.0F, 20000.0F, 100000.0F}) {
        for (bool const is_bar : {true, false}) {
            World world = testing::square_world();
            std::uint32_t const robot = add_disk(world, {200, 501}, {});
            // Both have a side at x = 501 that looks to the left.
            if (is_bar) {
                add_obstacle(world, {503, 500}, 0.0F, rectangle(4, 600));
            } else {
                add_obstacle(world, {501.0F + 173.2051F, 500}, 1.5707964F, triangle(600));
            }
            auto const engine = make_engine(world, {});
            set_velocity(world.bodies, robot, {speed_mm_s, 0}, 0.0F);
            for (int step = 0; step < 20; ++step) {
                engine->advance(world);
                ASSERT_LT(world.bodies.position_mm[robot].x, 501.0F) << speed_mm_s << " mm/s, step " << step;
            }
            EXPECT_NE(world.bodies.velocity_mm_s[robot].x, speed_mm_s);
        }
    }
}

TEST_P(Obstacles, HoldCrowdsThatPressAgainstThem) {
    World world = testing::square_world();
    for (int i = 0; i < 60; ++i) {
        add_disk(world, {100.0F + 60.0F * static_cast<float>(i % 10), 100.0F + 60.0F * static_cast<float>(i / 10)}, {},
                 disk(0.5F, 0.3F));
    }
    std::uint32_t const bar = add_obstacle(world, {500, 700}, 0.4F, rectangle(300, 40));
    std::uint32_t const wedge = add_obstacle(world, {750, 550}, 1.0F, triangle(160));
    auto const engine = make_engine(world, {});
    float deepest_mm = 0.0F;
    for (int step = 0; step < 1000; ++step) {
        for (std::uint32_t i = 0; i < world.robots.size(); ++i) {
            Vec2 const way_mm = Vec2{600, 800} - world.bodies.position_mm[i];
            world.robots.command[i] = {.velocity_mm_s = (100.0F / (1.0F + length(way_mm))) * way_mm, .pending = true};
        }
        engine->advance(world);
        for (std::uint32_t i = 0; i < world.robots.size(); ++i) {
            for (std::uint32_t const obstacle : {bar, wedge}) {
                float const gap_mm = signed_distance(world, obstacle, world.bodies.position_mm[i]) - kRadiusMm;
                deepest_mm = std::max(deepest_mm, -gap_mm);
            }
        }
    }
    EXPECT_LT(deepest_mm, GetParam() == "disk" ? 0.5F : 3.0F);
}

TEST_P(Obstacles, PushAsideWhatIsWhereTheyArePut) {
    World world = testing::square_world();
    std::uint32_t const robot = add_disk(world, {500, 300}, {});
    std::uint32_t const obstacle = add_obstacle(world, {500, 500}, 0.0F, rectangle(600, 20));
    auto const engine = make_engine(world, {});
    engine->advance(world);
    EXPECT_EQ(world.bodies.position_mm[robot], (Vec2{500, 300}));
    set_pose(world.bodies, obstacle, {500, 500}, 1.5707964F);  // upright, through the robot
    for (int step = 0; step < 200; ++step) {
        engine->advance(world);
    }
    EXPECT_GT(signed_distance(world, obstacle, world.bodies.position_mm[robot]), kRadiusMm - 0.6F);
}

POGOSIM_FOR_EACH_ENGINE(Obstacles);

}  // namespace
}  // namespace pogosim
