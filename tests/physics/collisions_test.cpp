// Collisions of bodies of every shape, against closed forms: conservation of momentum and of angular momentum, Newton's
// law of restitution.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "physics/physics_engine.hpp"
#include "support/each_engine.hpp"
#include "support/shapes.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_robot;
using testing::disk;
using testing::make_engine;
using testing::rectangle;
using testing::square_world;
using testing::triangle;

class Collisions : public testing::EachEngine {};
class Mass : public testing::EachEngine {};
class Shapes : public testing::EachEngine {};

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kToleranceMm = 0.55F;  // the engine's, and a step
constexpr Vec2 kMiddle{1000.0F, 1000.0F};

/// A world whose steps are so short that bodies collide where they touch.
World fine_world() {
    World world = square_world(2000.0F);
    world.time_step_s = 0.001;
    return world;
}

struct Material {
    float density = 10.0F;
    float restitution = 1.0F;
    float friction = 0.0F;
};

void add(World& world, Shape const& shape, Vec2 position_mm, Vec2 velocity_mm_s, Material const& material = {}) {
    ObjectSpec spec;
    spec.shape = shape;
    spec.robot.emplace();
    spec.body =
        BodySpec{.density = material.density, .friction = material.friction, .restitution = material.restitution};
    std::uint32_t const body = add_robot(world, position_mm, 0.0F, spec);
    world.bodies.velocity_mm_s[body] = velocity_mm_s;
}

void run(World& world, double seconds) {
    auto const engine = make_engine(world, {});
    for (auto steps = std::lround(seconds / world.time_step_s); steps > 0; --steps) {
        engine->advance(world);
    }
}

/// Area in units of (100 mm)^2.
float area(Shape const& shape) {
    switch (shape.kind) {
        case ShapeKind::rectangle:
            return shape.width_mm * shape.height_mm / 1e4F;
        case ShapeKind::triangle:
            return std::sqrt(3.0F) / 4.0F * shape.side_length_mm * shape.side_length_mm / 1e4F;
        default:
            return kPi * shape.radius_mm * shape.radius_mm / 1e4F;
    }
}

/// Mass of a body of density 10 relative to a disk of radius 26.5 mm, from the speed at which that disk rebounds after
/// it hits the body along `towards`, through both centres: u = (1 - m) / (1 + m) * v.
float mass_in_disks(Shape const& shape, Vec2 towards, float density = 10.0F) {
    World world = fine_world();
    float const far_mm = bounding_radius(shape) + 40.0F;
    add(world, shape, kMiddle, {}, {.density = density});
    add(world, disk(26.5F), kMiddle - far_mm * towards, 100.0F * towards);
    run(world, 1.0);
    float const ratio = dot(world.bodies.velocity_mm_s[1], towards) / 100.0F;
    EXPECT_NEAR(world.bodies.angular_velocity_rad_s[0], 0.0F, 1e-3F);
    return (1.0F - ratio) / (1.0F + ratio);
}

TEST_P(Mass, IsDensityTimesArea) {
    float const of_disk = area(disk(26.5F));
    Vec2 const right{1.0F, 0.0F};
    Vec2 const up{0.0F, -1.0F};  // against the flat side of a triangle
    for (float const radius_mm : {2.0F, 10.0F, 26.5F, 80.0F}) {
        EXPECT_NEAR(mass_in_disks(disk(radius_mm), right) / (area(disk(radius_mm)) / of_disk), 1.0F, 0.01F);
    }
    for (Shape const& shape : {rectangle(60, 40), rectangle(10, 150), rectangle(200, 100)}) {
        EXPECT_NEAR(mass_in_disks(shape, right) / (area(shape) / of_disk), 1.0F, 0.01F);
        EXPECT_NEAR(mass_in_disks(shape, up) / (area(shape) / of_disk), 1.0F, 0.01F);
    }
    for (float const side_mm : {40.0F, 100.0F, 200.0F}) {
        EXPECT_NEAR(mass_in_disks(triangle(side_mm), up) / (area(triangle(side_mm)) / of_disk), 1.0F, 0.01F);
    }
    EXPECT_NEAR(mass_in_disks(disk(26.5F), right, 30.0F), 3.0F, 0.03F);
}

TEST_P(Mass, SpeckIsPushedWithoutHarm) {
    for (float const size_mm : {1e-6F, 0.01F}) {
        for (Shape const& shape : {disk(size_mm), rectangle(size_mm, size_mm), rectangle(size_mm, 1e-30F),
                                   rectangle(20.0F, size_mm), triangle(size_mm)}) {
            World world = fine_world();
            add(world, shape, kMiddle, {});
            add(world, disk(26.5F), kMiddle - Vec2{50.0F, 0.0F}, {100.0F, 0.0F});
            run(world, 1.0);
            EXPECT_NEAR(world.bodies.velocity_mm_s[1].x, 100.0F, 10.0F) << size_mm;
            EXPECT_GT(world.bodies.position_mm[0].x, kMiddle.x)
                << size_mm << ", shape " << static_cast<int>(shape.kind) << ", width " << shape.width_mm;
        }
    }
}

/// How near a disk of radius 20 mm comes to the centre of a much heavier body before it is thrown back.
float nearest_approach_mm(Shape const& shape, Vec2 towards) {
    World world = fine_world();
    add(world, shape, kMiddle, {}, {.density = 1e6F});
    add(world, disk(20.0F), kMiddle - 150.0F * towards, 50.0F * towards);
    auto const engine = make_engine(world, {});
    float nearest_mm = 150.0F;
    for (int i = 0; i < 4000; ++i) {
        engine->advance(world);
        nearest_mm = std::min(nearest_mm, dot(kMiddle - world.bodies.position_mm[1], towards));
    }
    return nearest_mm;
}

TEST_P(Shapes, TouchAtTheirOutlines) {
    EXPECT_NEAR(nearest_approach_mm(disk(30), {1, 0}), 50.0F, kToleranceMm);
    EXPECT_NEAR(nearest_approach_mm(rectangle(100, 40), {1, 0}), 70.0F, kToleranceMm);
    EXPECT_NEAR(nearest_approach_mm(rectangle(100, 40), {0, 1}), 40.0F, kToleranceMm);
}

TEST_P(Shapes, TriangleHasOneCornerTowardsMinusYAtHeadingZero) {
    float const height_mm = std::sqrt(3.0F) / 2.0F * 120.0F;
    EXPECT_NEAR(nearest_approach_mm(triangle(120), {0, 1}), height_mm * 2.0F / 3.0F + 20.0F,
                kToleranceMm);                                                                         // from above
    EXPECT_NEAR(nearest_approach_mm(triangle(120), {0, -1}), height_mm / 3.0F + 20.0F, kToleranceMm);  // from below
}

TEST_P(Shapes, DoNotOverlapWhenTheyArePressedTogether) {
    struct Pair {
        Shape left;
        Shape right;
        float touch_mm;  // between the centres
    };
    std::array const pairs{Pair{disk(26.5F), disk(26.5F), 53.0F}, Pair{disk(5.0F), disk(40.0F), 45.0F},
                           Pair{rectangle(60, 80), rectangle(40, 60), 50.0F},
                           Pair{disk(20.0F), rectangle(40, 60), 40.0F}};
    for (Pair const& pair : pairs) {
        World world = square_world(2000.0F);
        add(world, pair.left, kMiddle - Vec2{pair.touch_mm + 1.0F, 0.0F}, {}, {.restitution = 0.0F});
        add(world, pair.right, kMiddle, {}, {.restitution = 0.0F});
        auto const engine = make_engine(world, {});
        for (int i = 0; i < 300; ++i) {
            world.robots.command[0] = {.velocity_mm_s = {20, 0}, .pending = true};
            world.robots.command[1] = {.velocity_mm_s = {-20, 0}, .pending = true};
            engine->advance(world);
        }
        float const gap_mm = world.bodies.position_mm[1].x - world.bodies.position_mm[0].x - pair.touch_mm;
        EXPECT_GT(gap_mm, -0.05F) << pair.touch_mm;
        EXPECT_LT(gap_mm, 0.5F) << pair.touch_mm;
    }
}

TEST_P(Collisions, HeadOnLosesRelativeSpeedByTheRestitutionAndKeepsMomentum) {
    for (float const restitution : {0.0F, 0.3F, 0.8F, 1.0F}) {
        World world = fine_world();
        Material const material{.density = 10.0F, .restitution = restitution};
        add(world, disk(26.5F), {900, 1000}, {100, 0}, material);
        add(world, disk(53.0F), {1020, 1000}, {-60, 0}, material);  // four times the mass
        run(world, 0.5);
        float const a = world.bodies.velocity_mm_s[0].x;
        float const b = world.bodies.velocity_mm_s[1].x;
        EXPECT_NEAR(a + 4.0F * b, 100.0F - 4.0F * 60.0F, 0.1F);
        EXPECT_NEAR(b - a, restitution * 160.0F, 0.5F) << restitution;
    }
}

/// Wherever in a step they meet.
TEST_P(Collisions, InelasticOneLeavesNoSpeedOfSeparation) {
    for (double const time_step_s : {0.001, 0.01, 0.016}) {
        for (Shape const& shape : {rectangle(53.0F, 53.0F), testing::capsule(53.0F, 30.0F)}) {
            for (int i = 0; i < 40; ++i) {
                World world = square_world(2000.0F);
                world.time_step_s = time_step_s;
                Material const soft{.restitution = 0.0F};
                add(world, shape, kMiddle, {}, soft);
                add(world, shape, kMiddle - Vec2{100.0F + 0.05F * static_cast<float>(i), 0.0F}, {100.0F, 0.0F}, soft);
                run(world, 1.5);
                EXPECT_NEAR(world.bodies.velocity_mm_s[0].x, 50.0F, 0.2F) << time_step_s << ", " << i;
                EXPECT_NEAR(world.bodies.velocity_mm_s[1].x, 50.0F, 0.2F) << time_step_s << ", " << i;
            }
        }
    }
}

/// Overlaps of disks within the tolerance are pushed apart, as slowly in short steps as in long ones.
TEST_P(Collisions, InelasticDisksPartNoFasterInShortSteps) {
    for (double const time_step_s : {0.0005, 0.001, 0.002, 0.005, 0.01, 0.016}) {
        for (int i = 0; i < 40; ++i) {
            World world = square_world(2000.0F);
            world.time_step_s = time_step_s;
            Material const soft{.restitution = 0.0F};
            add(world, disk(26.5F), kMiddle, {}, soft);
            add(world, disk(26.5F), kMiddle - Vec2{60.0F + 0.05F * static_cast<float>(i), 0.0F}, {100.0F, 0.0F}, soft);
            run(world, 0.5);
            EXPECT_NEAR(world.bodies.velocity_mm_s[0].x, 50.0F, 2.2F) << time_step_s << ", " << i;
            EXPECT_NEAR(world.bodies.velocity_mm_s[1].x, 50.0F, 2.2F) << time_step_s << ", " << i;
        }
    }
}

TEST_P(Collisions, FastRobotDoesNotJumpASmallBody) {
    // 25 mm per sub-step, and the other one is in the middle between two places of the robot.
    World world = square_world(2000.0F);
    add(world, disk(5.0F), {500, 1000}, {});
    add(world, disk(5.0F), {612.5F, 1000}, {});
    world.robots.command[0] = {.velocity_mm_s = {2e4F, 0}, .pending = true};
    auto const engine = make_engine(world, {});
    engine->advance(world);
    engine->advance(world);
    EXPECT_GT(world.bodies.velocity_mm_s[1].x, 1e3F);
    EXPECT_LT(world.bodies.position_mm[0].x, world.bodies.position_mm[1].x);
}

TEST_P(Collisions, ObliqueOneChangesVelocitiesAlongTheLineOfCentresOnly) {
    // The centres pass at half the sum of the radii: the line of centres is at 30 degrees to the path.
    constexpr float radius_mm = 30.0F;
    constexpr float restitution = 0.6F;
    World world = fine_world();
    add(world, disk(radius_mm), {900, 1000}, {100, 0}, {.restitution = restitution});
    add(world, disk(radius_mm), {1000, 1000 + radius_mm}, {}, {.restitution = restitution});
    run(world, 1.0);
    Vec2 const normal = direction(kPi / 6.0F);
    float const impulse_per_mass = (1.0F + restitution) / 2.0F * 100.0F * normal.x;
    Vec2 const a = Vec2{100, 0} - impulse_per_mass * normal;
    Vec2 const b = impulse_per_mass * normal;
    EXPECT_NEAR(world.bodies.velocity_mm_s[0].x, a.x, 0.7F);
    EXPECT_NEAR(world.bodies.velocity_mm_s[0].y, a.y, 0.7F);
    EXPECT_NEAR(world.bodies.velocity_mm_s[1].x, b.x, 0.7F);
    EXPECT_NEAR(world.bodies.velocity_mm_s[1].y, b.y, 0.7F);
    EXPECT_NEAR(world.bodies.angular_velocity_rad_s[0], 0.0F, 1e-4F);  // without friction nothing turns
    EXPECT_NEAR(world.bodies.angular_velocity_rad_s[1], 0.0F, 1e-4F);
}

/// Momentum of both bodies, and angular momentum about the middle, with their masses and moments of inertia.
struct Momenta {
    Vec2 linear;
    float angular = 0.0F;
};

Momenta momenta(World const& world, std::array<float, 2> masses, std::array<float, 2> inertias) {
    Momenta sum;
    for (std::size_t i = 0; i < 2; ++i) {
        Vec2 const momentum = masses[i] * world.bodies.velocity_mm_s[i];
        sum.linear = sum.linear + momentum;
        sum.angular += cross(world.bodies.position_mm[i] - kMiddle, momentum) +
                       inertias[i] * world.bodies.angular_velocity_rad_s[i];
    }
    return sum;
}

TEST_P(Collisions, RectangleHitOffItsCentreTurns) {
    // A disk hits the left side of a rectangle 40 mm from its middle, without friction.
    constexpr float restitution = 0.5F;
    constexpr float lever_mm = 40.0F;
    Shape const bar = rectangle(40, 160);
    float const disk_mass = 10.0F * area(disk(26.5F));
    float const bar_mass = 10.0F * area(bar);
    float const bar_inertia = bar_mass * (40.0F * 40.0F + 160.0F * 160.0F) / 12.0F;
    World world = fine_world();
    add(world, bar, kMiddle, {}, {.restitution = restitution});
    add(world, disk(26.5F), {900, 1000 - lever_mm}, {100, 0}, {.restitution = restitution});
    run(world, 0.8);

    float const impulse =
        (1.0F + restitution) * 100.0F / (1.0F / disk_mass + 1.0F / bar_mass + lever_mm * lever_mm / bar_inertia);
    EXPECT_NEAR(world.bodies.velocity_mm_s[0].x, impulse / bar_mass, 0.2F);
    EXPECT_NEAR(world.bodies.velocity_mm_s[0].y, 0.0F, 0.05F);
    EXPECT_NEAR(world.bodies.angular_velocity_rad_s[0], lever_mm * impulse / bar_inertia, 0.005F);
    EXPECT_NEAR(world.bodies.velocity_mm_s[1].x, 100.0F - impulse / disk_mass, 0.3F);

    Momenta const after = momenta(world, {bar_mass, disk_mass}, {bar_inertia, 0.5F * disk_mass * 26.5F * 26.5F});
    EXPECT_NEAR(after.linear.x / (disk_mass * 100.0F), 1.0F, 1e-3F);
    EXPECT_NEAR(after.angular / (lever_mm * disk_mass * 100.0F), 1.0F, 5e-3F);
}

TEST_P(Collisions, FrictionTurnsBodiesAndKeepsMomentumAndAngularMomentum) {
    Shape const wedge = triangle(120);
    float const disk_mass = 10.0F * area(disk(26.5F));
    float const wedge_mass = 10.0F * area(wedge);
    float const wedge_inertia = wedge_mass * 120.0F * 120.0F / 12.0F;
    std::array<float, 2> const masses{wedge_mass, disk_mass};
    std::array<float, 2> const inertias{wedge_inertia, 0.5F * disk_mass * 26.5F * 26.5F};
    World world = fine_world();
    Material const rough{.density = 10.0F, .restitution = 0.5F, .friction = 0.5F};
    add(world, wedge, kMiddle, {}, rough);
    add(world, disk(26.5F), {900, 990}, {100, 20}, rough);
    Momenta const before = momenta(world, masses, inertias);
    run(world, 0.8);
    Momenta const after = momenta(world, masses, inertias);
    EXPECT_GT(std::abs(world.bodies.angular_velocity_rad_s[1]), 0.1F);  // they did touch, roughly
    EXPECT_NEAR(after.linear.x / before.linear.x, 1.0F, 1e-3F);
    EXPECT_NEAR(after.linear.y / before.linear.y, 1.0F, 5e-3F);
    EXPECT_NEAR(after.angular / before.angular, 1.0F, 0.02F);
}

POGOSIM_FOR_EACH_ENGINE(Collisions);
POGOSIM_FOR_EACH_ENGINE(Mass);
POGOSIM_FOR_EACH_ENGINE(Shapes);

}  // namespace
}  // namespace pogosim
