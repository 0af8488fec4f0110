// Walls hold every body at every speed, size and time step.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "base/random.hpp"
#include "physics/physics_engine.hpp"
#include "support/each_engine.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_robot;
using testing::make_engine;
using testing::square_world;

class WallsAndSpeed : public testing::EachEngine {};

constexpr float kPi = std::numbers::pi_v<float>;

/// As many small ones as large ones.
float log_uniform(RandomStream& random, float low, float high) {
    return std::exp(random.uniform(std::log(low), std::log(high)));
}

template <class List>
auto const& one_of(RandomStream& random, List const& list) {
    return list[static_cast<std::size_t>(random.uniform() * static_cast<float>(std::size(list)))];
}

Arena bundled_arena(std::string const& name) {
    return scale_arena(read_arena_file(std::string(POGOSIM_SOURCE_DIR) + "/arenas/" + name + ".csv"), {});
}

/// A square with a comb of walls 1 mm thick, and one whose gaps end in corners of a few degrees.
Arena comb() {
    std::vector<Polygon> polygons{{{0, 0}, {1000, 0}, {1000, 1000}, {0, 1000}}};
    for (int i = 1; i < 8; ++i) {
        float const x = 125.0F * static_cast<float>(i);
        polygons.push_back({{x, 100}, {x + 1.0F, 100}, {x + 1.0F, 900}, {x, 900}});
    }
    return make_arena(polygons);
}

Arena saw() {
    Polygon outer{{0, 0}, {1000, 0}};
    for (int i = 10; i-- > 0;) {
        float const x = 100.0F * static_cast<float>(i);
        outer.push_back({x + 50.0F, 1000});
        outer.push_back({x, 300});
    }
    return make_arena({outer});
}

ObjectSpec body_of(Shape const& shape, float restitution = 0.5F) {
    ObjectSpec spec = testing::pogobot_spec();
    spec.shape = shape;
    spec.body = BodySpec{.restitution = restitution};
    return spec;
}

Shape random_shape(RandomStream& random, float radius_mm) {
    float const thin_mm = radius_mm * log_uniform(random, 0.05F, 1.4F);
    std::array const shapes{
        Shape{.kind = ShapeKind::disk, .radius_mm = radius_mm},
        Shape{.kind = ShapeKind::disk, .radius_mm = radius_mm},
        Shape{.kind = ShapeKind::rectangle, .width_mm = 1.4F * radius_mm, .height_mm = thin_mm},
        Shape{.kind = ShapeKind::triangle, .side_length_mm = 1.7F * radius_mm},
    };
    // The disk engine moves nothing else.
    return testing::engine_name == "disk" ? shapes[0] : one_of(random, shapes);
}

Vec2 free_place(Arena const& arena, float radius_mm, RandomStream& random) {
    for (;;) {
        Vec2 const size = arena.bounds.size();
        Vec2 const place{random.uniform(0.0F, size.x), random.uniform(0.0F, size.y)};
        if (arena.contains(place) && arena.distance_to_walls(place) >= radius_mm) {
            return place;
        }
    }
}

struct Scene {
    World world;
    float speed_mm_s = 0.0F;
    float angular_velocity_rad_s = 0.0F;
    std::string text;
};

/// Robots and passive bodies of one size; they may stand inside each other, as in a crowd that was pressed together.
Scene random_scene(std::vector<std::pair<std::string, Arena>> const& arenas, RandomStream& random) {
    Scene scene;
    auto const& [name, arena] = one_of(random, arenas);
    scene.world.arena = arena;
    scene.world.time_step_s = one_of(random, std::array{0.001, 0.01, 0.016, 0.1, 1.0});
    float const radius_mm = log_uniform(random, 0.01F, 25.0F);
    scene.speed_mm_s = log_uniform(random, 100.0F, 1e6F);
    scene.angular_velocity_rad_s = log_uniform(random, 0.1F, 1e4F);
    auto const count = static_cast<int>(random.uniform(1.0F, 25.0F));
    for (int i = 0; i < count; ++i) {
        add_robot(scene.world, free_place(arena, radius_mm, random), random.uniform(-kPi, kPi),
                  body_of(random_shape(random, radius_mm), random.uniform()));
    }
    scene.text = fmt::format("{}: {} bodies of {} mm, {} mm/s, {} s", name, count, radius_mm, scene.speed_mm_s,
                             scene.world.time_step_s);
    return scene;
}

/// Two of three are robots: they go straight, or all to one point and press; now and then they choose anew.
void steer(Scene& scene, Vec2 target_mm, RandomStream& random) {
    World& world = scene.world;
    for (std::size_t i = 0; i < world.robots.size(); ++i) {
        if (i % 3 == 2) {
            continue;
        }
        Vec2 const way = target_mm - world.bodies.position_mm[i];
        float const heading = i % 2 == 0 ? std::atan2(way.y, way.x) : world.bodies.heading_rad[i];
        Vec2 const noise{0.1F * random.normal(), 0.1F * random.normal()};
        world.robots.command[i] = {.velocity_mm_s = scene.speed_mm_s * (direction(heading) + noise),
                                   .angular_velocity_rad_s = scene.angular_velocity_rad_s * random.normal(),
                                   .pending = true};
    }
}

TEST_P(WallsAndSpeed, HoldEachBodyAtEverySpeedSizeAndStep) {
    std::vector<std::pair<std::string, Arena>> arenas{{"comb", comb()}, {"saw", saw()}};
    for (char const* const name : {"disk", "square", "H", "star", "star8", "arena8", "annulus", "annulusBarred",
                                   "squarewithHole", "arrow", "triangle"}) {
        arenas.emplace_back(name, bundled_arena(name));
    }
    RandomStream random(1, 0);
    int looks = 0;
    int sunk = 0;
    for (int scene_number = 0; scene_number < 80; ++scene_number) {
        Scene scene = random_scene(arenas, random);
        World& world = scene.world;
        auto const engine = make_engine(world, {.restitution = random.uniform()});
        Vec2 target_mm;
        for (int step = 0; step < 24; ++step) {
            if (step % 8 == 0) {
                target_mm = 1.2F * free_place(world.arena, 0.0F, random) - 0.1F * world.arena.bounds.size();
            }
            steer(scene, target_mm, random);
            engine->advance(world);
            for (std::size_t i = 0; i < world.bodies.size(); ++i) {
                Vec2 const place = world.bodies.position_mm[i];
                ASSERT_TRUE(world.arena.contains(place)) << scene.text << ": (" << place.x << ", " << place.y << ")";
                ASSERT_TRUE(std::isfinite(world.bodies.heading_rad[i])) << scene.text;
                float const radius_mm = inner_radius(world.bodies.shape[i]);
                float const distance_mm = world.arena.distance_to_walls(place);
                ASSERT_GT(distance_mm, 0.49F * radius_mm) << scene.text;
                sunk += distance_mm < radius_mm - 1.0F ? 1 : 0;
                ++looks;
            }
        }
    }
    // A crowd may press a body into a wall for a moment.
    EXPECT_LT(sunk, looks / 1000);
}

TEST_P(WallsAndSpeed, FastRobotSlidesAlongThem) {
    for (float const speed_mm_s : {1e3F, 1e4F, 1e5F}) {
        World world = square_world(1000.0F);
        world.time_step_s = 0.001;
        add_robot(world, {500, 950}, 0.0F, body_of({.radius_mm = 26.5F}, 0.0F));
        auto const engine = make_engine(world, {.friction = 0.0F, .restitution = 0.0F});
        float const along_mm = 0.6F * speed_mm_s * 0.001F;
        int const steps = std::max(1, static_cast<int>(300.0F / along_mm));
        for (int i = 0; i < steps; ++i) {
            world.robots.command[0] = {.velocity_mm_s = {0.6F * speed_mm_s, 0.8F * speed_mm_s}, .pending = true};
            engine->advance(world);
        }
        EXPECT_NEAR(world.bodies.position_mm[0].x, 500.0F + along_mm * static_cast<float>(steps), 2.0F) << speed_mm_s;
        EXPECT_NEAR(world.bodies.position_mm[0].y, 1000.0F - 26.5F - 0.65F, 0.651F) << speed_mm_s;
    }
}

TEST_P(WallsAndSpeed, ThrowFastSpecksBack) {
    // Far too small and fast for the engine to see the wall.
    World world = square_world(1000.0F);
    add_robot(world, {500, 500}, 0.0F, body_of({.radius_mm = 0.1F}, 0.0F));
    world.bodies.velocity_mm_s[0] = {1e4F, 0};
    auto const engine = make_engine(world, {.friction = 0.0F, .restitution = 0.5F});
    for (int i = 0; i < 8; ++i) {
        engine->advance(world);
    }
    EXPECT_NEAR(world.bodies.velocity_mm_s[0].x, -5e3F, 1.0F);
}

TEST(Walls, ThrowFastSpecksBackWithinAStep) {
    // 1 m in a step, four times the way to the wall.
    World world = square_world(500.0F);
    add_robot(world, {250, 250}, 0.0F, body_of({.radius_mm = 0.1F}, 0.0F));
    world.robots.command[0] = {.velocity_mm_s = {1e5F, 0}, .pending = true};
    make_engine(world, {.friction = 0.0F, .restitution = 0.5F})->advance(world);
    EXPECT_NEAR(world.bodies.velocity_mm_s[0].x, -5e4F, 1.0F);
    EXPECT_LT(world.bodies.position_mm[0].x, 400.0F);
}

TEST_P(WallsAndSpeed, PressedRobotStopsLittleMoreThanAMillimetreBefore) {
    World world = square_world(1000.0F);
    add_robot(world, {900, 500}, 0.0F, body_of({.radius_mm = 26.5F}, 0.0F));
    auto const engine = make_engine(world, {.restitution = 0.0F});
    for (int i = 0; i < 500; ++i) {
        world.robots.command[0] = {.velocity_mm_s = {20, 0}, .pending = true};
        engine->advance(world);
    }
    EXPECT_NEAR(world.bodies.position_mm[0].x, 1000.0F - 26.5F - 0.65F, 0.651F);
}

TEST_P(WallsAndSpeed, KeepsEachBodyWithinItsBoundsAtEverySpeed) {
    RandomStream random(2, 0);
    for (float const speed_mm_s : {1e3F, 1e5F, 1e6F}) {
        World world = square_world(1128.3792F);
        world.periodic = true;
        for (int i = 0; i < 10; ++i) {
            add_robot(world, free_place(world.arena, 0.0F, random), random.uniform(-kPi, kPi));
        }
        auto const engine = make_engine(world, {});
        for (int step = 0; step < 100; ++step) {
            for (std::size_t i = 0; i < world.robots.size(); ++i) {
                world.robots.command[i] = {.velocity_mm_s = speed_mm_s * direction(world.bodies.heading_rad[i]),
                                           .pending = true};
            }
            engine->advance(world);
            for (Vec2 const place : world.bodies.position_mm) {
                ASSERT_TRUE(world.arena.bounds.contains(wrapped(world, place))) << place.x << ", " << place.y;
            }
        }
    }
}

TEST_P(WallsAndSpeed, IsWhatTheMotorsAskForHoweverFarAStepGoes) {
    for (float const speed_mm_s : {100.0F, 3e4F, 1e6F}) {
        World world = square_world(1e6F);
        add_robot(world, {1000, 5e5F});
        world.robots.command[0] = {
            .velocity_mm_s = {speed_mm_s, 0}, .angular_velocity_rad_s = 1000.0F, .pending = true};
        make_engine(world, {})->advance(world);
        EXPECT_NEAR(world.bodies.position_mm[0].x, 1000.0F + 0.01F * speed_mm_s, 1.0F);
        EXPECT_NEAR(world.bodies.heading_rad[0], wrap_angle(10.0F), 1e-3F);
    }
}

POGOSIM_FOR_EACH_ENGINE(WallsAndSpeed);

}  // namespace
}  // namespace pogosim
