#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/physics_engine.hpp"
#include "support/each_engine.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_robot;
using testing::make_engine;
using testing::square_world;

class Motion : public testing::EachEngine {};

ObjectSpec body(float restitution, float friction = 0.0F, float damping = 0.0F) {
    ObjectSpec spec = testing::pogobot_spec();
    spec.body = BodySpec{.linear_damping = damping,
                         .angular_damping = damping,
                         .density = 10.0F,
                         .friction = friction,
                         .restitution = restitution};
    return spec;
}

void run(World& world, double seconds, WallSpec const& walls = {}) {
    auto const engine = make_engine(world, walls);
    auto const steps = std::lround(seconds / world.time_step_s);
    for (long i = 0; i < steps; ++i) {
        engine->advance(world);
    }
}

TEST_P(Motion, FreeBodyMovesStraightAtConstantSpeed) {
    World world = square_world(5000.0F);
    add_robot(world, {1000, 1000}, 0.0F, body(0.5F));
    world.bodies.velocity_mm_s[0] = {100, 50};
    world.bodies.angular_velocity_rad_s[0] = 1.0F;
    run(world, 10.0);
    EXPECT_NEAR(world.bodies.position_mm[0].x, 2000.0F, 0.1F);
    EXPECT_NEAR(world.bodies.position_mm[0].y, 1500.0F, 0.1F);
    EXPECT_NEAR(world.bodies.heading_rad[0], wrap_angle(10.0F), 1e-3F);
}

TEST_P(Motion, DampedBodySlowsDownExponentially) {
    World world = square_world(5000.0F);
    add_robot(world, {1000, 1000}, 0.0F, body(0.5F, 0.0F, 0.3F));
    world.bodies.velocity_mm_s[0] = {100, 0};
    world.bodies.angular_velocity_rad_s[0] = 2.0F;
    run(world, 5.0);
    // Box2D's implicit step differs from the exponential by a factor of 1 - damping * time step / 2.
    float const error = GetParam() == "disk" ? 1e-4F : 2e-3F;
    float const left = std::exp(-0.3F * 5.0F);
    EXPECT_NEAR(world.bodies.velocity_mm_s[0].x, 100.0F * left, 100.0F * error);
    EXPECT_NEAR(world.bodies.angular_velocity_rad_s[0], 2.0F * left, 2.5F * error);
    EXPECT_NEAR(world.bodies.position_mm[0].x, 1000.0F + 100.0F / 0.3F * (1.0F - left), 500.0F * error);
}

/// So little in a step that the formula for it has few digits.
TEST_P(Motion, WeaklyDampedBodySlowsDownExponentially) {
    World world = square_world(5000.0F);
    add_robot(world, {1000, 1000}, 0.0F, body(0.5F, 0.0F, 0.05F));
    world.bodies.velocity_mm_s[0] = {100, 0};
    run(world, 20.0);
    float const error = GetParam() == "disk" ? 1e-4F : 2e-3F;
    float const left = std::exp(-0.05F * 20.0F);
    EXPECT_NEAR(world.bodies.velocity_mm_s[0].x, 100.0F * left, 100.0F * error);
    EXPECT_NEAR(world.bodies.position_mm[0].x, 1000.0F + 100.0F / 0.05F * (1.0F - left), 2000.0F * error);
}

TEST_P(Motion, BodyThatOnlyTurnsGoesOnTurning) {
    World world = square_world();
    add_robot(world, {500, 500}, 0.0F, body(0.5F));
    world.bodies.angular_velocity_rad_s[0] = 3.0F;
    run(world, 2.0);
    EXPECT_NEAR(world.bodies.heading_rad[0], wrap_angle(6.0F), 1e-3F);
}

/// A heading that grows with each turn would soon be rounded to more than a step's turn.
TEST_P(Motion, BodyThatHasTurnedForHoursTurnsAsFastAsBefore) {
    constexpr double kHours = 3.0;
    constexpr double kHour = 3600.0;
    World world = square_world();
    world.time_step_s = 0.01;
    add_robot(world, {500, 500}, 0.0F, body(0.5F));
    world.bodies.angular_velocity_rad_s[0] = 20.0F;
    auto const engine = make_engine(world, {});
    auto const steps = std::lround(kHours * kHour / world.time_step_s);
    double turned_rad = 0.0;
    for (long i = 0; i < steps; ++i) {
        float const before_rad = world.bodies.heading_rad[0];
        engine->advance(world);
        turned_rad += static_cast<double>(wrap_angle(world.bodies.heading_rad[0] - before_rad));
    }
    EXPECT_NEAR(turned_rad / (20.0 * kHours * kHour), 1.0, 1e-4);
    set_velocity(world.bodies, 0, {}, 0.05F);  // slower ones fall asleep in Box2D
    float const before_rad = world.bodies.heading_rad[0];
    for (int i = 0; i < 1000; ++i) {
        engine->advance(world);
    }
    EXPECT_NEAR(wrap_angle(world.bodies.heading_rad[0] - before_rad), 0.5F, 5e-4F);
}

TEST_P(Motion, ElasticHeadOnCollisionSwapsTheVelocities) {
    World world = square_world(5000.0F);
    add_robot(world, {1000, 1000}, 0.0F, body(1.0F));
    add_robot(world, {1100, 1000}, 0.0F, body(1.0F));
    world.bodies.velocity_mm_s[0] = {100, 0};
    world.bodies.velocity_mm_s[1] = {-50, 0};
    run(world, 1.0);
    EXPECT_NEAR(world.bodies.velocity_mm_s[0].x, -50.0F, 0.5F);
    EXPECT_NEAR(world.bodies.velocity_mm_s[1].x, 100.0F, 0.5F);
}

TEST_P(Motion, CollisionKeepsMomentumAndLosesSpeedByTheRestitution) {
    World world = square_world(5000.0F);
    add_robot(world, {1000, 1000}, 0.0F, body(0.5F));
    add_robot(world, {1100, 1000}, 0.0F, body(0.2F));
    world.bodies.velocity_mm_s[0] = {100, 0};
    run(world, 1.0);
    Vec2 const a = world.bodies.velocity_mm_s[0];
    Vec2 const b = world.bodies.velocity_mm_s[1];
    EXPECT_NEAR(a.x + b.x, 100.0F, 0.1F);
    EXPECT_NEAR(b.x - a.x, 50.0F, 0.5F);  // the larger of both restitutions
}

TEST_P(Motion, WallThrowsABodyBackFasterIfItsRestitutionIsAboveOne) {
    for (float const restitution : {1.2F, 1.8F, 3.0F}) {
        World world = square_world(1000.0F);
        add_robot(world, {500, 500}, 0.0F, body(0.0F));
        world.bodies.velocity_mm_s[0] = {100, 0};
        run(world, 4.9, {.friction = 0.0F, .restitution = restitution});
        EXPECT_NEAR(world.bodies.velocity_mm_s[0].x, -100.0F * restitution, 0.5F);
        EXPECT_NEAR(world.bodies.velocity_mm_s[0].y, 0.0F, 0.1F);
    }
}

TEST_P(Motion, WallsThatAddEnergyHoldABodyAndLimitItsSpeed) {
    World world = square_world(1000.0F);
    add_robot(world, {500, 500}, 0.0F, body(0.0F));
    world.bodies.velocity_mm_s[0] = {100, 37};
    auto const engine = make_engine(world, {.friction = 0.0F, .restitution = 1.8F});
    float fastest_mm_s = 0.0F;
    for (int i = 0; i < 2000; ++i) {
        engine->advance(world);
        Vec2 const place = world.bodies.position_mm[0];
        ASSERT_TRUE(place.x > 20.0F && place.x < 980.0F && place.y > 20.0F && place.y < 980.0F);
        fastest_mm_s = std::max(fastest_mm_s, length(world.bodies.velocity_mm_s[0]));
    }
    EXPECT_GT(fastest_mm_s, 1000.0F);
    EXPECT_LT(fastest_mm_s, 1.5F * kMostBounceMmS);  // each axis
}

TEST_P(Motion, WallThrowsABodyBackByItsRestitution) {
    for (Vec2 const velocity : {Vec2{100, 0}, Vec2{-100, 0}, Vec2{0, 100}, Vec2{0, -100}}) {
        World world = square_world(300.0F);
        add_robot(world, {150, 150}, 0.0F, body(0.0F));
        world.bodies.velocity_mm_s[0] = velocity;
        run(world, 1.8, {.friction = 0.0F, .restitution = 0.5F});
        EXPECT_NEAR(world.bodies.velocity_mm_s[0].x, -0.5F * velocity.x, 1.0F);
        EXPECT_NEAR(world.bodies.velocity_mm_s[0].y, -0.5F * velocity.y, 1.0F);
    }
}

TEST_P(Motion, FrictionOfAWallTurnsARobotThatDrivesAgainstIt) {
    // Motors ask for v at an angle to the wall and for no rotation, 60 times per second. Each time, the wall takes the
    // speed against it, v sin(angle), and its friction gives the disk an angular velocity of 2 mu v sin(angle) / r.
    // With a restitution e, the impulse is 1 + e times as large, but the robot is back at the wall only after
    // e / (1 + e) of the time between two ticks, so it turns as far.
    constexpr double seconds = 6.0;
    for (float const restitution : {0.0F, 0.5F}) {
        for (float const angle_rad : {0.26F, 0.52F, 1.05F}) {
            World world = square_world(5000.0F);
            add_robot(world, {500.0F, 26.6F}, 0.0F, body(restitution, 0.3F));
            auto const engine = make_engine(world, {.friction = 0.05F, .restitution = restitution});
            double next_tick_s = 0.0;
            for (int step = 0; step < 600; ++step) {
                if (0.01 * step >= next_tick_s - 1e-9) {
                    world.robots.command[0] = {.velocity_mm_s = 100.0F * direction(-angle_rad), .pending = true};
                    next_tick_s += 1.0 / 60.0;
                }
                engine->advance(world);
            }
            double const expected = -2.0 * std::sqrt(0.3 * 0.05) * 100.0 * std::sin(angle_rad) / 26.5 * seconds;
            float const error = wrap_angle(world.bodies.heading_rad[0] - static_cast<float>(expected));
            EXPECT_NEAR(error / expected, 0.0, 0.02) << restitution << ", " << angle_rad;
        }
    }
}

TEST_P(Motion, HolesPushOutwards) {
    World world = square_world(1000.0F);
    world.arena.polygons.push_back({{400, 400}, {600, 400}, {600, 600}, {400, 600}});
    add_robot(world, {200, 500}, 0.0F, body(0.0F));
    world.bodies.velocity_mm_s[0] = {100, 0};
    run(world, 5.0, {.friction = 0.0F, .restitution = 0.0F});
    EXPECT_NEAR(world.bodies.position_mm[0].x, 400.0F - 26.5F, 1.0F);
}

TEST_P(Motion, FastBodyDoesNotJumpAWall) {
    World world = square_world(1000.0F);
    add_robot(world, {500, 500}, 0.0F, body(0.0F));
    world.robots.command[0] = {.velocity_mm_s = {15000, 0}, .angular_velocity_rad_s = 0.0F, .pending = true};
    run(world, 1.0);
    EXPECT_LT(world.bodies.position_mm[0].x, 1000.0F - 26.5F + 1.0F);
}

TEST_P(Motion, DriveIsImposedOnce) {
    World world = square_world(5000.0F);
    add_robot(world, {1000, 1000}, 0.0F, body(0.5F, 0.0F, 1.0F));
    world.robots.command[0] = {.velocity_mm_s = {100, 0}, .angular_velocity_rad_s = 1.0F, .pending = true};
    run(world, 1.0);
    EXPECT_FALSE(world.robots.command[0].pending);
    EXPECT_NEAR(world.bodies.velocity_mm_s[0].x, 100.0F * std::exp(-1.0F), 0.5F);
}

TEST_P(Motion, BodyLeavingAPeriodicWorldComesBackOnTheOtherSide) {
    World world = square_world(1000.0F);
    world.periodic = true;
    add_robot(world, {950, 20}, 0.0F, body(0.5F));
    world.bodies.velocity_mm_s[0] = {100, -100};
    run(world, 1.0);
    EXPECT_NEAR(world.bodies.position_mm[0].x, 50.0F, 0.1F);
    EXPECT_NEAR(world.bodies.position_mm[0].y, 920.0F, 0.1F);
}

POGOSIM_FOR_EACH_ENGINE(Motion);

TEST(WhyUnfit, NamesWhatIsMissingAndWhatIsThere) {
    World linked = square_world();
    add_robot(linked, {500, 500}, 0.0F, body(0.5F));
    linked.links = {{.a = 0, .end_a_mm = {}, .end_b_mm = {500, 500}}};
    for (bool const has_box2d : {true, false}) {
        EXPECT_EQ(why_unfit("auto", linked, has_box2d), "");
        EXPECT_EQ(why_unfit("disk", linked, has_box2d), "");
    }
    EXPECT_EQ(why_unfit("box2d", linked, true), "");
    EXPECT_EQ(why_unfit("box2d", linked, false), "is not there: this simulator was built without Box2D 2.4; use auto");
    linked.periodic = true;
    EXPECT_EQ(why_unfit("box2d", linked, true), "does not hold links in a periodic arena; use auto");
    EXPECT_EQ(why_unfit("disk", linked, true), "");
}

}  // namespace
}  // namespace pogosim
