// Soft membranes of disks and of segments by themselves: what physics says of them, with each engine.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <tuple>

#include "base/random.hpp"
#include "geometry/polygon.hpp"
#include "physics/physics_engine.hpp"
#include "support/each_engine.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_ring;
using testing::make_engine;

class Membranes : public testing::EachEngine {};

class MembranesOfBothKinds : public ::testing::TestWithParam<std::tuple<std::string, bool>> {
protected:
    void SetUp() override { testing::engine_name = std::get<0>(GetParam()); }
    bool segments() const { return std::get<1>(GetParam()); }
};

World ring_world(testing::RingSpec const& ring = {}) {
    World world = testing::square_world();
    add_ring(world, ring);
    return world;
}

void run(World& world, double seconds) {
    auto const engine = make_engine(world, {});
    for (long i = std::lround(seconds / world.time_step_s); i > 0; --i) {
        engine->advance(world);
    }
}

Polygon line_of(World const& world) {
    return world.bodies.position_mm;
}

/// Dots all weigh the same.
Vec2 mean_velocity_mm_s(World const& world) {
    Vec2 sum;
    for (Vec2 const velocity_mm_s : world.bodies.velocity_mm_s) {
        sum = sum + velocity_mm_s;
    }
    return (1.0F / static_cast<float>(world.bodies.size())) * sum;
}

/// Turning about the middle, per mass and dot, mm^2/s. That of the dots about themselves is left out: nothing turns
/// them.
double angular_momentum(World const& world) {
    Vec2 const middle_mm = centre_mm(world, world.objects[0]);
    Vec2 const drift_mm_s = mean_velocity_mm_s(world);
    double sum = 0.0;
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        sum += static_cast<double>(
            cross(world.bodies.position_mm[i] - middle_mm, world.bodies.velocity_mm_s[i] - drift_mm_s));
    }
    return sum / static_cast<double>(world.bodies.size());
}

double energy(World const& world) {
    double sum = 0.0;
    for (Vec2 const velocity_mm_s : world.bodies.velocity_mm_s) {
        sum += static_cast<double>(squared_length(velocity_mm_s));
    }
    return sum;
}

TEST_P(MembranesOfBothKinds, FlyStraightAtConstantSpeed) {
    World world = ring_world({.centre_mm = {300, 300}, .segments = segments()});
    world.bodies.velocity_mm_s.assign(world.bodies.size(), {100, 50});
    run(world, 4.0);
    Vec2 const middle_mm = centre_mm(world, world.objects[0]);
    EXPECT_NEAR(middle_mm.x, 700.0F, 0.5F);
    EXPECT_NEAR(middle_mm.y, 500.0F, 0.5F);
    EXPECT_NEAR(signed_area(line_of(world)) / signed_area(line_of(ring_world({.segments = segments()}))), 1.0, 1e-3);
}

TEST_P(MembranesOfBothKinds, KeepTheirMomentumWhileTheyShake) {
    World world = ring_world({.segments = segments()});
    RandomStream random(3, 0);
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        Vec2 const turning = {-(world.bodies.position_mm[i].y - 500.0F), world.bodies.position_mm[i].x - 500.0F};
        world.bodies.velocity_mm_s[i] =
            Vec2{20.0F, -10.0F} + 0.3F * turning + Vec2{30.0F * random.normal(), 30.0F * random.normal()};
    }
    Vec2 const drift_mm_s = mean_velocity_mm_s(world);
    double const turning = angular_momentum(world);
    double const first_energy = energy(world);
    run(world, 2.0);
    EXPECT_LT(length(mean_velocity_mm_s(world) - drift_mm_s), 0.1F);
    EXPECT_NEAR(angular_momentum(world) / turning, 1.0, 0.02);
    EXPECT_LT(energy(world), first_energy);  // springs are damped
    EXPECT_NEAR(signed_area(line_of(world)) / signed_area(line_of(ring_world({.segments = segments()}))), 1.0, 0.02);
}

TEST_P(Membranes, KeepTheirMomentumWhateverTheNumberOfDots) {
    for (std::uint32_t const dots : {4U, 5U, 7U, 11U, 14U, 33U, 50U}) {
        World world = ring_world({.dots = dots});
        RandomStream random(3, dots);
        for (Vec2& velocity_mm_s : world.bodies.velocity_mm_s) {
            velocity_mm_s = {20.0F + 30.0F * random.normal(), 30.0F * random.normal()};
        }
        Vec2 const drift_mm_s = mean_velocity_mm_s(world);
        double const first_energy = energy(world);
        run(world, 2.0);
        EXPECT_LT(length(mean_velocity_mm_s(world) - drift_mm_s), 0.1F) << dots;
        EXPECT_LT(energy(world), first_energy) << dots;
        Vec2 const middle_mm = centre_mm(world, world.objects[0]);
        for (Vec2 const place_mm : world.bodies.position_mm) {
            EXPECT_NEAR(length(place_mm - middle_mm), 200.0F, 25.0F) << dots;
        }
    }
}

TEST_P(MembranesOfBothKinds, BecomeRoundAgainAfterTheyWereCrushed) {
    World world = ring_world({.damping_per_s = 2.0F, .segments = segments()});
    double const area_mm2 = signed_area(line_of(world));
    auto const engine = make_engine(world, {});
    // An ellipse of 0.6 times the area.
    for (std::uint32_t i = 0; i < world.bodies.size(); ++i) {
        Vec2 const way = world.bodies.position_mm[i] - Vec2{500, 500};
        Vec2 const ahead = direction(world.bodies.heading_rad[i]);
        set_pose(world.bodies, i, Vec2{500.0F + 0.6F * way.x, 500.0F + way.y}, std::atan2(ahead.y, 0.6F * ahead.x));
    }
    for (int step = 0; step < 1000; ++step) {
        engine->advance(world);
    }
    EXPECT_NEAR(signed_area(line_of(world)) / area_mm2, 1.0, 0.02);
    Vec2 const middle_mm = centre_mm(world, world.objects[0]);
    for (Vec2 const place_mm : world.bodies.position_mm) {
        EXPECT_NEAR(length(place_mm - middle_mm), 200.0F, 6.0F);
    }
}

TEST_P(MembranesOfBothKinds, ComeToRestAndStayThere) {
    World world = ring_world({.damping_per_s = 3.0F, .segments = segments()});
    world.bodies.velocity_mm_s.assign(world.bodies.size(), {50, 20});
    auto const engine = make_engine(world, {});
    for (int step = 0; step < 600; ++step) {
        engine->advance(world);
    }
    std::vector<Vec2> const before_mm = world.bodies.position_mm;
    EXPECT_EQ(energy(world), 0.0);
    engine->advance(world);
    EXPECT_EQ(world.bodies.position_mm, before_mm);
}

TEST_P(MembranesOfBothKinds, StayInOnePieceWhileRobotsPushFromInside) {
    World world = testing::square_world();
    Membrane const membrane = add_ring(world, {.dots = 40, .damping_per_s = 1.0F, .segments = segments()});
    RandomStream random(5, 0);
    for (int k = 0; k < 12; ++k) {
        Vec2 const place_mm{410.0F + 60.0F * static_cast<float>(k % 4), 440.0F + 60.0F * static_cast<float>(k / 4)};
        std::uint32_t const robot = testing::add_body(world, place_mm, 0.0F, testing::pogobot_spec());
        world.objects.push_back({.id = robot, .body = robot, .body_count = 1});
    }
    auto const engine = make_engine(world, {});
    for (int step = 0; step < 1500; ++step) {
        for (std::uint32_t robot = membrane.body_count; robot < world.bodies.size(); ++robot) {
            if (step % 50 == 0) {
                set_pose(world.bodies, robot, world.bodies.position_mm[robot], random.uniform(-3.0F, 3.0F));
            }
            set_velocity(world.bodies, robot, 80.0F * direction(world.bodies.heading_rad[robot]), 0.0F);
        }
        engine->advance(world);
        for (Joint const& joint : world.joints) {
            if (joint.length_mm == 0.0F) {
                auto const end_mm = [&](std::uint32_t body, Vec2 own_mm) {
                    return world.bodies.position_mm[body] + rotate(own_mm, direction(world.bodies.heading_rad[body]));
                };
                float const apart_mm = length(end_mm(joint.a, joint.anchor_a_mm) - end_mm(joint.b, joint.anchor_b_mm));
                ASSERT_LT(apart_mm, 1.5F) << "step " << step;
            }
        }
    }
    Polygon const line(world.bodies.position_mm.begin(), world.bodies.position_mm.begin() + membrane.body_count);
    for (std::uint32_t robot = membrane.body_count; robot < world.bodies.size(); ++robot) {
        EXPECT_TRUE(contains(line, world.bodies.position_mm[robot])) << robot;
    }
}

/// Robots that are stretching it, and have stopped.
TEST_P(MembranesOfBothKinds, CalmDownAroundRobotsThatHoldThemOut) {
    World world = testing::square_world();
    Membrane const membrane = add_ring(world, {.dots = 100, .damping_per_s = 0.3F, .segments = segments()});
    for (int k = 0; k < 6; ++k) {
        std::uint32_t const robot =
            testing::add_body(world, Vec2{500, 500} + 90.0F * direction(1.0471976F * static_cast<float>(k)), 0.0F,
                              testing::pogobot_spec());
        world.objects.push_back({.id = robot, .body = robot, .body_count = 1});
    }
    auto const engine = make_engine(world, {});
    auto const push = [&](double seconds, float speed_mm_s) {
        for (int step = 0; step < std::lround(seconds / 0.01); ++step) {
            for (std::uint32_t robot = membrane.body_count; robot < world.bodies.size(); ++robot) {
                Vec2 const ahead = direction(1.0471976F * static_cast<float>(robot - membrane.body_count));
                set_velocity(world.bodies, robot, speed_mm_s * ahead, 0.0F);
            }
            engine->advance(world);
        }
    };
    push(1.6, 100.0F);
    double const pushed = energy(world);
    push(6.0, 0.0F);
    EXPECT_LT(energy(world), 0.1 * pushed);
}

TEST(MembranesOfTheDiskEngine, KeepTheirShapeAcrossTheSeam) {
    for (bool const segments : {false, true}) {
        World world = ring_world({.segments = segments});
        world.periodic = true;
        world.bodies.velocity_mm_s.assign(world.bodies.size(), {400, 300});
        double const area_mm2 = signed_area(line_of(world));
        auto const engine = make_physics_engine("disk", world, {}, testing::one_worker());
        for (int step = 0; step < 1000; ++step) {
            engine->advance(world);
            ASSERT_NEAR(signed_area(line_of(world)) / area_mm2, 1.0, 1e-3);
            Vec2 const middle_mm = centre_mm(world, world.objects[0]);
            ASSERT_LT(length(minimum_image(world, middle_mm, wrapped(world, middle_mm))), 0.01F);
            ASSERT_GT(middle_mm.x, -0.01F);
            ASSERT_LT(middle_mm.x, 1000.01F);
        }
        EXPECT_LT(length(mean_velocity_mm_s(world) - Vec2{400, 300}), 0.5F);
    }
}

TEST_P(Membranes, SpringsDoNotStretchBeyondTheirLimitByMuchWhenTheyArePulled) {
    // Two heavy disks fly apart inside and pull the ring out.
    World world = testing::square_world(3000.0F);
    Membrane const membrane = add_ring(world, {.centre_mm = {1500, 1500}});
    ObjectSpec heavy = testing::pogobot_spec();
    heavy.shape.radius_mm = 60.0F;
    heavy.body->density = 10.0F;
    for (float const side : {-1.0F, 1.0F}) {
        std::uint32_t const disk = testing::add_body(world, {1500.0F + 100.0F * side, 1500.0F}, 0.0F, heavy);
        world.bodies.velocity_mm_s[disk] = {100.0F * side, 0.0F};
        world.objects.push_back({.id = disk, .body = disk, .body_count = 1});
    }
    auto const engine = make_engine(world, {});
    for (int step = 0; step < 300; ++step) {
        engine->advance(world);
        for (Joint const& joint : world.joints) {
            if (joint.max_stretch > 0.0F) {
                float const now_mm = length(world.bodies.position_mm[joint.b] - world.bodies.position_mm[joint.a]);
                ASSERT_LT(now_mm, 1.08F * joint.length_mm) << "step " << step;
            }
        }
    }
    // Both are held inside.
    Polygon const line(world.bodies.position_mm.begin(), world.bodies.position_mm.begin() + membrane.body_count);
    EXPECT_TRUE(contains(line, world.bodies.position_mm[membrane.body_count]));
    EXPECT_TRUE(contains(line, world.bodies.position_mm[membrane.body_count + 1]));
}

POGOSIM_FOR_EACH_ENGINE(Membranes);
INSTANTIATE_TEST_SUITE_P(Physics, MembranesOfBothKinds,
                         ::testing::Combine(::testing::Values("box2d", "disk"), ::testing::Bool()),
                         [](auto const& info) {
                             return std::get<0>(info.param) + (std::get<1>(info.param) ? "_segments" : "_disks");
                         });

}  // namespace
}  // namespace pogosim
