// Springs, rods and hinges between bodies against closed forms, with each engine.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

#include "base/random.hpp"
#include "physics/physics_engine.hpp"
#include "support/each_engine.hpp"
#include "support/shapes.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_body;
using testing::make_engine;
using testing::pogobot_spec;
using testing::square_world;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kRadiusMm = 26.5F;

class Links : public testing::EachEngine {
protected:
    bool is_ours() const { return GetParam() == "disk"; }

    /// Box2D needs short steps: it loses energy at each one.
    double time_step_s() const { return is_ours() ? 0.01 : 0.001; }
};

/// An object that nothing slows down.
void add(World& world, Vec2 place_mm, Shape const& shape) {
    ObjectSpec spec = pogobot_spec();
    spec.shape = shape;
    spec.body = BodySpec{.density = 10.0F, .friction = 0.3F, .restitution = 0.5F};
    spec.body->linear_damping = spec.body->angular_damping = 0.0F;
    world.objects.push_back({.body = add_body(world, place_mm, 0.0F, spec), .body_count = 1});
}

void add_disk(World& world, Vec2 place_mm) {
    add(world, place_mm, testing::disk(kRadiusMm));
}

void add_box(World& world, Vec2 place_mm, float width_mm, float height_mm) {
    add(world, place_mm, testing::rectangle(width_mm, height_mm));
}

/// A disk's mass, kg.
constexpr float kMassKg = 10.0F * kPi * kRadiusMm * kRadiusMm * 1e-4F;

Link spring(std::uint32_t a, std::uint32_t b, float length_mm, float stiffness_n_m, float damping_n_s_m = 0.0F) {
    return {.kind = LinkKind::spring,
            .a = a,
            .b = b,
            .end_a_mm = {},
            .end_b_mm = {},
            .length_mm = length_mm,
            .stiffness_n_m = stiffness_n_m,
            .damping_n_s_m = damping_n_s_m};
}

/// To a place in the arena.
Link spring_to(Vec2 place_mm, std::uint32_t a, float length_mm, float stiffness_n_m) {
    Link link = spring(a, kNone, length_mm, stiffness_n_m);
    link.end_b_mm = place_mm;
    return link;
}

Link rod(std::uint32_t a, std::uint32_t b, float length_mm) {
    return {.kind = LinkKind::rod, .a = a, .b = b, .end_a_mm = {}, .end_b_mm = {}, .length_mm = length_mm};
}

Link hinge(std::uint32_t a, Vec2 end_a_mm, std::uint32_t b, Vec2 end_b_mm) {
    return {.kind = LinkKind::hinge, .a = a, .b = b, .end_a_mm = end_a_mm, .end_b_mm = end_b_mm};
}

int steps_of(World const& world, double seconds) {
    return static_cast<int>(std::lround(seconds / world.time_step_s));
}

void run(World& world, double seconds) {
    auto const engine = make_engine(world, {});
    for (int i = steps_of(world, seconds); i > 0; --i) {
        engine->advance(world);
    }
}

/// The times at which a quantity crosses zero upwards give its mean period.
template <class Quantity>
double period_s(World& world, double seconds, Quantity const& quantity) {
    auto const engine = make_engine(world, {});
    std::vector<double> crossings;
    double before = quantity();
    for (int i = 1; i <= steps_of(world, seconds); ++i) {
        engine->advance(world);
        double const now = quantity();
        if (before < 0.0 && now >= 0.0) {
            crossings.push_back((i - now / (now - before)) * world.time_step_s);
        }
        before = now;
    }
    return crossings.size() < 2 ? 0.0
                                : (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
}

float distance_mm(World const& world, std::uint32_t a, std::uint32_t b) {
    return length(world.bodies.position_mm[b] - world.bodies.position_mm[a]);
}

double energy_j(World const& world) {
    double sum = 0.0;
    for (Vec2 const velocity_mm_s : world.bodies.velocity_mm_s) {
        sum += 0.5e-6 * static_cast<double>(kMassKg * squared_length(velocity_mm_s));
    }
    return sum;
}

TEST_P(Links, SpringSwingsAtTheFrequencyOfItsTwoMasses) {
    World world = square_world();
    add_disk(world, {440, 500});
    add_disk(world, {560, 500});
    world.links = {spring(0, 1, 100.0F, 40.0F)};
    double const expected_s = 2.0 * std::numbers::pi / std::sqrt(2.0 * 40.0 / static_cast<double>(kMassKg));
    EXPECT_NEAR(period_s(world, 20.0, [&] { return distance_mm(world, 0, 1) - 100.0F; }) / expected_s, 1.0, 0.01);
}

TEST_P(Links, DampedSpringDiesAwayExponentially) {
    World world = square_world();
    add_disk(world, {440, 500});
    add_disk(world, {560, 500});
    world.time_step_s = 0.001;
    world.links = {spring(0, 1, 100.0F, 40.0F, 0.5F)};
    // The relative coordinate has half the mass of a disk.
    float const rate_per_s = 0.5F / kMassKg;
    auto const engine = make_engine(world, {});
    float most_mm = 0.0F;
    for (int i = 0; i < 6000; ++i) {
        engine->advance(world);
        most_mm = i < 5000 ? 0.0F : std::max(most_mm, distance_mm(world, 0, 1) - 100.0F);
    }
    // The last maximum is within a period (1.04 s) of the fifth second.
    EXPECT_LT(most_mm, 20.0F * std::exp(-5.0F * rate_per_s) * 1.02F);
    EXPECT_GT(most_mm, 20.0F * std::exp(-6.1F * rate_per_s) * 0.9F);
}

TEST_P(Links, SpringAtTheRimTurnsItsDisk) {
    World world = square_world();
    add_disk(world, {500, 500});
    world.bodies.heading_rad[0] = 0.1F;
    world.bodies.heading_dir[0] = direction(0.1F);
    Link pin = hinge(0, {}, kNone, {500, 500});
    // Far away, so that it pulls along x.
    Link pull = spring_to({900, 500}, 0, 0.0F, 5.0F);
    pull.end_a_mm = {kRadiusMm, 0};
    pull.length_mm = 300.0F;
    world.links = {pin, pull};
    // A pendulum: I w^2 = F r (1 + r / d), with the force F at rest and the distance d of the pull.
    double const force_n = 5.0 * (373.5 - 300.0) * 1e-3;
    double const inertia = 0.5 * static_cast<double>(kMassKg) * 26.5e-3 * 26.5e-3;
    double const w = std::sqrt(force_n * 26.5e-3 * (1.0 + 26.5 / 373.5) / inertia);
    double const measured_s = period_s(world, 20.0, [&] { return world.bodies.heading_rad[0]; });
    EXPECT_NEAR(measured_s * w / (2.0 * std::numbers::pi), 1.0, 0.01);
    EXPECT_LT(length(world.bodies.position_mm[0] - Vec2{500, 500}), 0.05F);
}

TEST_P(Links, RodKeepsItsLengthWhileItTurns) {
    World world = square_world();
    add_disk(world, {440, 500});
    add_disk(world, {560, 500});
    world.bodies.velocity_mm_s = {{0, -120}, {0, 120}};
    world.links = {rod(0, 1, 120.0F)};
    world.time_step_s = time_step_s();
    auto const engine = make_engine(world, {});
    float turned_rad = 0.0F;
    Vec2 before = world.bodies.position_mm[1] - world.bodies.position_mm[0];
    for (int i = steps_of(world, 5.0); i > 0; --i) {
        engine->advance(world);
        ASSERT_NEAR(distance_mm(world, 0, 1), 120.0F, is_ours() ? 0.1F : 1.0F);
        Vec2 const now = world.bodies.position_mm[1] - world.bodies.position_mm[0];
        turned_rad += std::atan2(cross(before, now), dot(before, now));
        before = now;
    }
    EXPECT_NEAR(turned_rad / 10.0F, 1.0F, 0.01F);  // 2 rad/s
    // m v^2 / r
    EXPECT_NEAR(world.links[0].tension_n / (kMassKg * 0.12F * 0.12F / 0.06F), 1.0F, 0.02F);
    EXPECT_NEAR(energy_j(world) / static_cast<double>(kMassKg * 0.12F * 0.12F), 1.0, 0.02);
}

TEST_P(Links, HingeToTheArenaLetsABoxTurnAboutItsEnd) {
    World world = square_world();
    add_box(world, {550, 500}, 100.0F, 20.0F);
    world.links = {hinge(0, {-50, 0}, kNone, {500, 500})};
    world.bodies.velocity_mm_s = {{0, 100}};
    world.bodies.angular_velocity_rad_s = {2.0F};
    world.time_step_s = time_step_s();
    run(world, 2.0);
    EXPECT_NEAR(world.bodies.angular_velocity_rad_s[0], 2.0F, 0.02F);
    Vec2 const end_mm = world.bodies.position_mm[0] - 50.0F * world.bodies.heading_dir[0];
    EXPECT_LT(length(end_mm - Vec2{500, 500}), is_ours() ? 0.1F : 0.5F);
    float const mass_kg = 10.0F * 100.0F * 20.0F * 1e-4F;
    EXPECT_NEAR(world.links[0].tension_n / (mass_kg * 2.0F * 2.0F * 0.05F), 1.0F, 0.02F);
}

TEST_P(Links, LimitsOfAHingeStopTheTurning) {
    World world = square_world();
    add_box(world, {450, 500}, 100.0F, 20.0F);
    add_box(world, {550, 500}, 100.0F, 20.0F);
    Link elbow = hinge(0, {50, 0}, 1, {-50, 0});
    elbow.least_rad = -kPi / 6.0F;
    elbow.most_rad = kPi / 4.0F;
    for (float const spin_rad_s : {3.0F, -3.0F}) {
        World folding = world;
        folding.links = {elbow};
        folding.bodies.angular_velocity_rad_s = {-spin_rad_s, spin_rad_s};
        folding.bodies.velocity_mm_s = {{0, -50 * spin_rad_s}, {0, -50 * spin_rad_s}};
        auto const engine = make_engine(folding, {});
        float reached_rad = 0.0F;
        for (int i = 0; i < 200; ++i) {
            engine->advance(folding);
            float const angle_rad = wrap_angle(folding.bodies.heading_rad[1] - folding.bodies.heading_rad[0]);
            reached_rad = std::abs(angle_rad) > std::abs(reached_rad) ? angle_rad : reached_rad;
        }
        float const limit_rad = spin_rad_s > 0.0F ? elbow.most_rad : elbow.least_rad;
        EXPECT_NEAR(reached_rad, limit_rad, is_ours() ? 0.01F : 0.05F);
    }
}

TEST_P(Links, OnesThatOverlapAboutAHingeDoNotPushEachOther) {
    World world = square_world();
    add_disk(world, {490, 500});
    add_disk(world, {510, 500});
    world.links = {hinge(0, {10, 0}, 1, {-10, 0})};
    run(world, 1.0);
    EXPECT_NEAR(distance_mm(world, 0, 1), 20.0F, 1e-3F);
}

TEST_P(Links, SpringsAndRodsLetTheirBodiesCollide) {
    World world = square_world();
    add_disk(world, {400, 500});
    add_disk(world, {600, 500});
    world.links = {spring(0, 1, 10.0F, 20.0F, 1.0F)};
    auto const engine = make_engine(world, {});
    for (int i = 0; i < 1000; ++i) {
        engine->advance(world);
        ASSERT_GT(distance_mm(world, 0, 1), 2.0F * kRadiusMm - (is_ours() ? 0.5F : 5.0F));
    }
    EXPECT_NEAR(distance_mm(world, 0, 1), 2.0F * kRadiusMm, 1.0F);
}

TEST_P(Links, ChainIsTautUnderThePullOfItsLast) {
    World world = square_world(3000.0F);
    constexpr std::uint32_t count = 20;
    for (std::uint32_t i = 0; i < count; ++i) {
        add_disk(world, {100.0F + 60.0F * static_cast<float>(i), 500});
        world.bodies.spec[i].linear_damping = 2.0F;
        if (i > 0) {
            world.links.push_back(rod(i - 1, i, 60.0F));
        }
    }
    auto const engine = make_engine(world, {});
    for (int i = 0; i < 500; ++i) {
        set_velocity(world.bodies, count - 1, {50.0F, 0.0F}, 0.0F);
        engine->advance(world);
    }
    for (std::uint32_t i = 1; i < count; ++i) {
        EXPECT_NEAR(distance_mm(world, i - 1, i), 60.0F, 0.5F) << i;
        EXPECT_GT(world.links[i - 1].tension_n, 0.0F);
        // What pulls also pulls all that follow.
        if (i > 1) {
            EXPECT_GT(world.links[i - 1].tension_n, world.links[i - 2].tension_n);
        }
    }
}

/// M. Born and T. von Karman (1912): w = 2 sqrt(k / m) sin(n pi / 2 (N + 1)) for a chain with fixed ends.
TEST_P(Links, ChainOfSpringsHasItsNormalModes) {
    constexpr std::uint32_t count = 8;
    for (std::uint32_t const mode : {1U, 2U, 5U}) {
        World world = square_world();
        constexpr float spacing_mm = 80.0F;
        auto const shape = [&](std::uint32_t i) {
            return std::sin(static_cast<float>(mode * (i + 1)) * kPi / static_cast<float>(count + 1));
        };
        for (std::uint32_t i = 0; i < count; ++i) {
            add_disk(world, {100.0F + spacing_mm * static_cast<float>(i + 1) + 5.0F * shape(i), 500});
        }
        float const stiffness_n_m = 30.0F;
        world.links.push_back(spring_to({100, 500}, 0, spacing_mm, stiffness_n_m));
        for (std::uint32_t i = 1; i < count; ++i) {
            world.links.push_back(spring(i - 1, i, spacing_mm, stiffness_n_m));
        }
        world.links.push_back(spring_to({100.0F + spacing_mm * (count + 1), 500}, count - 1, spacing_mm, 30.0F));
        double const expected_s = std::numbers::pi / (std::sqrt(static_cast<double>(stiffness_n_m / kMassKg)) *
                                                      std::sin(mode * std::numbers::pi / (2.0 * (count + 1))));
        float const rest_mm = 100.0F + spacing_mm;
        double const measured_s =
            period_s(world, 8.0 * expected_s, [&] { return world.bodies.position_mm[0].x - rest_mm; });
        EXPECT_NEAR(measured_s / expected_s, 1.0, 0.01) << mode;
    }
}

TEST_P(Links, TooStiffSpringIsStableAndKeepsItsLength) {
    World world = square_world();
    add_disk(world, {440, 500});
    add_disk(world, {550, 500});
    world.links = {spring(0, 1, 100.0F, 1e9F)};
    auto const engine = make_engine(world, {});
    for (int i = 0; i < 200; ++i) {
        engine->advance(world);
        ASSERT_TRUE(is_finite(world.bodies.position_mm[0]));
        ASSERT_NEAR(distance_mm(world, 0, 1), 100.0F, 11.0F);
    }
    EXPECT_NEAR(distance_mm(world, 0, 1), 100.0F, 0.1F);
}

TEST_P(Links, BreakWhenTheForceIsMoreThanTheyBear) {
    for (float const breaking_n : {0.9F, 1.2F}) {
        World world = square_world();
        add_disk(world, {400, 500});
        add_disk(world, {500, 500});
        // 1.05 N when it is longest.
        world.links = {spring(0, 1, 79.0F, 50.0F)};
        world.links[0].breaking_n = breaking_n;
        run(world, 2.0);
        EXPECT_EQ(world.links[0].is_cut, breaking_n < 1.0F) << breaking_n;
        EXPECT_EQ(world.link_changes, breaking_n < 1.0F ? 1U : 0U);
    }
}

TEST_P(Links, BreakWhenTheyArePushedTooHard) {
    World world = square_world();
    add_disk(world, {400, 500});
    add_disk(world, {500, 500});
    world.links = {spring(0, 1, 121.0F, 50.0F)};  // -1.05 N when it is shortest
    world.links[0].breaking_n = 0.9F;
    run(world, 2.0);
    EXPECT_TRUE(world.links[0].is_cut);
}

/// Against a fixed box that is turned, counted from a rest angle that is not 0.
TEST_P(Links, LimitsCountFromTheAngleAtRest) {
    for (float const spin_rad_s : {2.0F, -2.0F}) {
        World world = square_world();
        add_box(world, {550, 500}, 100.0F, 20.0F);
        add_box(world, {450, 500}, 60.0F, 20.0F);
        world.bodies.spec[1].fixed = true;
        world.bodies.heading_rad[1] = 2.5F;
        world.bodies.heading_dir[1] = direction(2.5F);
        Link elbow = hinge(0, {-50, 0}, 1, rotate({50, 0}, direction(-2.5F)));
        elbow.rest_rad = 2.5F;
        elbow.least_rad = -0.6F;
        elbow.most_rad = 0.3F;
        world.links = {elbow};
        world.bodies.angular_velocity_rad_s[0] = spin_rad_s;
        world.bodies.velocity_mm_s[0] = {0, 50.0F * spin_rad_s};
        auto const engine = make_engine(world, {});
        float reached_rad = 0.0F;
        for (int i = 0; i < 200; ++i) {
            engine->advance(world);
            float const angle_rad = -world.bodies.heading_rad[0];  // of the fixed one against it, from rest
            reached_rad = std::abs(angle_rad) > std::abs(reached_rad) ? angle_rad : reached_rad;
        }
        EXPECT_NEAR(reached_rad, spin_rad_s > 0.0F ? -0.6F : 0.3F, is_ours() ? 0.01F : 0.05F);
    }
}

TEST(LinksOfTheDiskEngine, LimitsOfHalfATurnHoldOnBothSides) {
    for (auto const& [least_deg, most_deg, spin_rad_s] :
         {std::tuple(-180.0F, 30.0F, 3.0F), std::tuple(-30.0F, 180.0F, -3.0F), std::tuple(-180.0F, 180.0F, 3.0F)}) {
        World world = square_world();
        add_box(world, {500, 500}, 100.0F, 20.0F);
        world.links = {hinge(0, {}, kNone, {500, 500})};
        world.links[0].least_rad = least_deg * kPi / 180.0F;
        world.links[0].most_rad = most_deg * kPi / 180.0F;
        world.bodies.angular_velocity_rad_s = {spin_rad_s};
        auto const engine = make_physics_engine("disk", world, {}, testing::one_worker());
        float turned_rad = 0.0F;
        for (int i = 0; i < 800; ++i) {
            float const before_rad = world.bodies.heading_rad[0];
            engine->advance(world);
            turned_rad += wrap_angle(world.bodies.heading_rad[0] - before_rad);
        }
        // The arena has turned the other way against it.
        EXPECT_NEAR(-turned_rad, spin_rad_s > 0.0F ? world.links[0].least_rad : world.links[0].most_rad, 0.01F);
    }
}

TEST_P(Links, WhatOnlyTurnsAboutAHingeTurnsOn) {
    World world = square_world();
    add_disk(world, {500, 500});
    world.links = {hinge(0, {}, kNone, {500, 500})};
    world.bodies.angular_velocity_rad_s = {1.0F};
    run(world, 2.0);
    EXPECT_NEAR(world.bodies.heading_rad[0], 2.0F, 0.01F);
}

/// Its frequency is five times that of the same spring at the centre, for which alone there would be too few sub-steps.
TEST(LinksOfTheDiskEngine, StiffSpringAtALongArmKeepsItsEnergy) {
    World world = square_world();
    add_box(world, {500, 500}, 200.0F, 4.0F);
    Link pull = spring_to({600, 560}, 0, 50.0F, 3000.0F);
    pull.end_a_mm = {100, 0};
    world.links = {hinge(0, {}, kNone, {500, 500}), pull};
    auto const engine = make_physics_engine("disk", world, {}, testing::one_worker());
    float most_late_rad = 0.0F;
    float most_early_rad = 0.0F;
    for (int i = 0; i < 3000; ++i) {
        engine->advance(world);
        float const away_rad = std::abs(world.bodies.heading_rad[0]);
        most_early_rad = i < 300 ? std::max(most_early_rad, away_rad) : most_early_rad;
        most_late_rad = i >= 2700 ? std::max(most_late_rad, away_rad) : 0.0F;
    }
    EXPECT_GT(most_early_rad, 0.1F);
    EXPECT_NEAR(most_late_rad / most_early_rad, 1.0F, 0.05F);
}

TEST(LinksOfTheDiskEngine, SpringWhoseEndsCoincidePushesThemApart) {
    World world = square_world();
    add_disk(world, {500, 500});
    world.links = {spring_to({500, 500}, 0, 50.0F, 50.0F)};
    auto const engine = make_physics_engine("disk", world, {}, testing::one_worker());
    for (int i = 0; i < 50; ++i) {
        engine->advance(world);
    }
    EXPECT_GT(length(world.bodies.position_mm[0] - Vec2{500, 500}), 5.0F);
}

TEST_P(Links, MadeAndCutDuringARunTakeEffectAtTheNextStep) {
    World world = square_world();
    add_disk(world, {400, 500});
    add_disk(world, {500, 500});
    auto const engine = make_engine(world, {});
    for (int i = 0; i < 50; ++i) {
        engine->advance(world);
    }
    EXPECT_EQ(distance_mm(world, 0, 1), 100.0F);
    world.links.push_back(spring(0, 1, 60.0F, 20.0F));
    ++world.link_changes;
    for (int i = 0; i < 10; ++i) {
        engine->advance(world);
    }
    EXPECT_LT(distance_mm(world, 0, 1), 99.0F);
    EXPECT_GT(world.links[0].tension_n, 0.0F);
    world.links[0].is_cut = true;
    ++world.link_changes;
    Vec2 const velocity_mm_s = world.bodies.velocity_mm_s[0];
    for (int i = 0; i < 10; ++i) {
        engine->advance(world);
    }
    EXPECT_NEAR(world.bodies.velocity_mm_s[0].x, velocity_mm_s.x, 1e-3F);
    EXPECT_EQ(world.links[0].tension_n, 0.0F);
}

TEST_P(Links, HoldToWhatIsFixed) {
    World world = square_world();
    add_disk(world, {400, 500});
    add_disk(world, {500, 500});
    world.bodies.spec[0].fixed = true;
    world.links = {spring(0, 1, 90.0F, 20.0F)};
    double const expected_s = 2.0 * std::numbers::pi / std::sqrt(20.0 / static_cast<double>(kMassKg));
    EXPECT_NEAR(period_s(world, 20.0, [&] { return distance_mm(world, 0, 1) - 90.0F; }) / expected_s, 1.0, 0.01);
    EXPECT_EQ(world.bodies.position_mm[0], (Vec2{400, 500}));
}

/// Box2D's springs lose energy at every step.
TEST(LinksOfTheDiskEngine, UndampedSpringKeepsItsEnergy) {
    World world = square_world();
    add_disk(world, {440, 500});
    add_disk(world, {560, 500});
    world.links = {spring(0, 1, 100.0F, 400.0F)};
    auto const engine = make_physics_engine("disk", world, {}, testing::one_worker());
    float longest_mm = 0.0F;
    for (int i = 0; i < 10000; ++i) {
        engine->advance(world);
        longest_mm = i < 9900 ? 0.0F : std::max(longest_mm, distance_mm(world, 0, 1));
    }
    EXPECT_NEAR(longest_mm - 100.0F, 20.0F, 0.4F);
}

TEST(LinksOfTheDiskEngine, HoldAcrossTheSeam) {
    World world = square_world();
    world.periodic = true;
    add_disk(world, {40, 500});
    add_disk(world, {960, 500});
    world.bodies.velocity_mm_s = {{100, 30}, {100, 30}};
    world.links = {rod(0, 1, 80.0F)};
    auto const engine = make_physics_engine("disk", world, {}, testing::one_worker());
    for (int i = 0; i < 2000; ++i) {
        engine->advance(world);
        ASSERT_NEAR(length(minimum_image(world, world.bodies.position_mm[0], world.bodies.position_mm[1])), 80.0F,
                    0.05F);
    }
    EXPECT_NEAR(world.bodies.velocity_mm_s[0].x, 100.0F, 0.1F);
    EXPECT_NEAR(world.bodies.velocity_mm_s[0].y, 30.0F, 0.1F);
}

TEST(LinksOfTheDiskEngine, KeepMomentumInALatticeThatIsShaken) {
    World world = square_world(2000.0F);
    constexpr std::uint32_t side = 6;
    for (std::uint32_t i = 0; i < side * side; ++i) {
        add_disk(world, {700.0F + 70.0F * static_cast<float>(i % side), 700.0F + 70.0F * static_cast<float>(i / side)});
        world.bodies.velocity_mm_s.back() = {30.0F * std::sin(1.7F * static_cast<float>(i)), 10.0F};
        if (i % side > 0) {
            world.links.push_back(spring(i - 1, i, 70.0F, 50.0F));
        }
        if (i >= side) {
            world.links.push_back(i % 2 == 0 ? spring(i - side, i, 70.0F, 50.0F) : rod(i - side, i, 70.0F));
        }
    }
    auto const momentum = [&] {
        Vec2 sum;
        for (Vec2 const velocity : world.bodies.velocity_mm_s) {
            sum = sum + velocity;
        }
        return sum;
    };
    Vec2 const before = momentum();
    auto const engine = make_physics_engine("disk", world, {}, testing::one_worker());
    for (int i = 0; i < 300; ++i) {
        engine->advance(world);
    }
    EXPECT_LT(length(momentum() - before), 0.5F);
    EXPECT_LT(energy_j(world), 1.0);
}

/// Twice the kinetic energy, per mass: all boxes weigh the same.
double energy_of_boxes(World const& world) {
    double sum = 0.0;
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        Shape const& box = world.bodies.shape[i];
        float const gyration_mm2 = (box.width_mm * box.width_mm + box.height_mm * box.height_mm) / 12.0F;
        float const spin_rad_s = world.bodies.angular_velocity_rad_s[i];
        sum +=
            static_cast<double>(squared_length(world.bodies.velocity_mm_s[i]) + gyration_mm2 * spin_rad_s * spin_rad_s);
    }
    return sum;
}

/// The largest distance between the ends of a hinge.
float widest_hinge_mm(World const& world) {
    float widest_mm = 0.0F;
    auto const end_mm = [&](std::uint32_t body, Vec2 own_mm) {
        return world.bodies.position_mm[body] + rotate(own_mm, direction(world.bodies.heading_rad[body]));
    };
    for (Link const& link : world.links) {
        if (link.kind == LinkKind::hinge) {
            widest_mm = std::max(widest_mm, length(end_mm(link.a, link.end_a_mm) - end_mm(link.b, link.end_b_mm)));
        }
    }
    return widest_mm;
}

TEST(LinksOfTheDiskEngine, FoldingChainLosesEnergyOnlyWhenItsBoxesMeet) {
    World world = square_world();
    for (std::uint32_t k = 0; k < 3; ++k) {
        add_box(world, {400.0F + 31.0F * static_cast<float>(k), 500}, 31.0F, 10.0F);
        if (k > 0) {
            world.links.push_back(hinge(k - 1, {15.5F, 0}, k, {-15.5F, 0}));
        }
    }
    world.bodies.angular_velocity_rad_s = {15, 0, -15};
    auto const engine = make_physics_engine("disk", world, {}, testing::one_worker());
    engine->advance(world);
    double const first = energy_of_boxes(world);
    for (int i = 0; i < 25; ++i) {
        engine->advance(world);
        EXPECT_NEAR(energy_of_boxes(world) / first, 1.0, 0.002);
    }
    for (int i = 0; i < 300; ++i) {
        engine->advance(world);
        EXPECT_LT(energy_of_boxes(world), 1.002 * first);
        EXPECT_LT(widest_hinge_mm(world), 0.02F);
    }
    EXPECT_LT(energy_of_boxes(world), 0.3 * first);  // the outer boxes met, with a restitution of 0.5
}

/// Robots that drive and turn at each second step, until the chain is folded and its robots press against each other.
TEST(LinksOfTheDiskEngine, DrivenChainStaysWholeAndSlow) {
    for (std::uint32_t const count : {5U, 20U}) {
        for (bool const has_spring : {false, true}) {
            World world = square_world(3000.0F);
            for (std::uint32_t i = 0; i < count; ++i) {
                add_disk(world, {600.0F + 60.0F * static_cast<float>(i), 1500});
                if (i > 0) {
                    world.links.push_back(hinge(i - 1, {30, 0}, i, {-30, 0}));
                }
            }
            if (has_spring) {
                world.links.push_back(spring(0, count - 1, 60.0F * static_cast<float>(count - 1), 1e-6F));
            }
            auto const engine = make_physics_engine("disk", world, {}, testing::one_worker());
            for (int step = 0; step < 3000; ++step) {
                for (std::uint32_t i = 0; i < count && step % 2 == 0; ++i) {
                    Vec2 const ahead = direction(world.bodies.heading_rad[i]);
                    set_velocity(world.bodies, i, 60.0F * ahead, i % 3 == 0 ? 1.0F : -0.5F);
                }
                engine->advance(world);
                for (std::uint32_t i = 0; i < count; ++i) {
                    ASSERT_LT(length(world.bodies.position_mm[i] - world.bodies.start_mm[i]), 3.0F) << step;
                }
                ASSERT_LT(widest_hinge_mm(world), 1.0F) << step;
            }
        }
    }
}

TEST(LinksOfTheDiskEngine, LetThroughNoLinkedDiskHoweverFast) {
    World world = square_world(4000.0F);
    add_disk(world, {1777, 2000});
    add_disk(world, {2233, 2000});
    world.bodies.velocity_mm_s = {{15000, 0}, {-15000, 0}};
    world.links = {spring(0, 1, 456.0F, 0.001F)};
    auto const engine = make_physics_engine("disk", world, {}, testing::one_worker());
    for (int i = 0; i < 20; ++i) {
        engine->advance(world);
        ASSERT_GT(world.bodies.position_mm[1].x - world.bodies.position_mm[0].x, 2.0F * kRadiusMm - 1.0F);
    }
}

/// Two robots that drive and turn, held by a rod so short that it turns by much in a step.
TEST(LinksOfTheDiskEngine, ShortRodFromRimToRimHolds) {
    for (float const gap_mm : {0.6F, 3.0F, 27.0F}) {
        World world = square_world();
        add_disk(world, {450, 500});
        add_disk(world, {450.0F + 2.0F * kRadiusMm + gap_mm, 500});
        Link link = rod(0, 1, gap_mm);
        link.end_a_mm = {kRadiusMm, 0};
        link.end_b_mm = {-kRadiusMm, 0};
        world.links = {link};
        RandomStream random(11, 0);
        auto const engine = make_physics_engine("disk", world, {}, testing::one_worker());
        for (int step = 0; step < 3000; ++step) {
            for (std::uint32_t i = 0; i < 2 && step % 2 == 0; ++i) {
                float const turn_rad_s = step % 100 < 30 ? 2.0F : 0.0F;
                set_velocity(world.bodies, i, 100.0F * direction(world.bodies.heading_rad[i]),
                             random.uniform(0.5F, 1.0F) * turn_rad_s);
            }
            engine->advance(world);
            auto const end_mm = [&](std::uint32_t body, Vec2 own_mm) {
                return world.bodies.position_mm[body] + rotate(own_mm, direction(world.bodies.heading_rad[body]));
            };
            ASSERT_NEAR(length(end_mm(1, link.end_b_mm) - end_mm(0, link.end_a_mm)), gap_mm, 1.0F) << step;
            ASSERT_LT(length(world.bodies.position_mm[0] - world.bodies.start_mm[0]), 3.0F) << step;
        }
    }
}

/// Forces that no float can hold, on bodies as light as they may be.
TEST(LinksOfTheDiskEngine, StiffestSpringsOnLightestBodiesStayFinite) {
    for (float const stiffness_n_m : {1e5F, 1e9F, 1e30F}) {
        for (bool const boxes : {false, true}) {
            World world = square_world();
            for (std::uint32_t i = 0; i < 4; ++i) {
                Vec2 const place_mm{300.0F + 100.0F * static_cast<float>(i), 500};
                boxes ? add_box(world, place_mm, 80.0F, 60.0F) : add_disk(world, place_mm);
                world.bodies.spec[i].density = i == 1 ? 10.0F : 1e-3F;
                if (i > 0) {
                    world.links.push_back(spring(i - 1, i, 100.0F, stiffness_n_m, i == 2 ? 1e30F : 0.0F));
                }
            }
            add_disk(world, {450, 400});
            auto const engine = make_physics_engine("disk", world, {}, testing::one_worker());
            for (int step = 0; step < 1000; ++step) {
                set_velocity(world.bodies, 4, 100.0F * direction(0.01F * static_cast<float>(step)), 0.0F);
                engine->advance(world);
                for (std::uint32_t i = 0; i < world.bodies.size(); ++i) {
                    ASSERT_TRUE(is_finite(world.bodies.position_mm[i])) << step;
                    ASSERT_LT(length(world.bodies.position_mm[i] - world.bodies.start_mm[i]), 20.0F) << step;
                }
            }
        }
    }
}

/// Boxes that are thrown about tie it into knots, in which links and contacts push against each other.
TEST(LinksOfTheDiskEngine, ClosedChainOfHingesGainsNoEnergyHoweverItIsThrown) {
    constexpr std::uint32_t count = 40;
    for (auto const& [speed_mm_s, stiffness_n_m] :
         {std::pair(50.0F, 0.0F), std::pair(500.0F, 0.0F), std::pair(3000.0F, 0.0F), std::pair(100.0F, 1e-6F),
          std::pair(400.0F, 30.0F)}) {
        World world = square_world(4000.0F);
        auto const corner_mm = [&](std::uint32_t k) {
            return Vec2{2000, 2000} + 200.0F * direction(2.0F * kPi * static_cast<float>(k) / count);
        };
        float const side_mm = length(corner_mm(1) - corner_mm(0));
        for (std::uint32_t k = 0; k < count; ++k) {
            Vec2 const way_mm = corner_mm(k + 1) - corner_mm(k);
            add_box(world, corner_mm(k) + 0.5F * way_mm, side_mm, 10.0F);
            set_pose(world.bodies, k, world.bodies.position_mm[k], std::atan2(way_mm.y, way_mm.x));
            world.bodies.velocity_mm_s[k] = speed_mm_s * direction(1.7F * static_cast<float>(k * k % 17));
            world.links.push_back(hinge(k, {0.5F * side_mm, 0}, (k + 1) % count, {-0.5F * side_mm, 0}));
        }
        if (stiffness_n_m > 0.0F) {
            world.links.push_back(spring(0, count / 2, 400.0F, stiffness_n_m));  // nearly as long as it is
        }
        double const first = energy_of_boxes(world);
        auto const engine = make_physics_engine("disk", world, {}, testing::one_worker());
        for (int i = 0; i < 500; ++i) {
            engine->advance(world);
            ASSERT_LT(energy_of_boxes(world), 1.01 * first) << speed_mm_s << " mm/s, step " << i;
        }
        EXPECT_LT(widest_hinge_mm(world), 0.5F) << speed_mm_s;
    }
}

POGOSIM_FOR_EACH_ENGINE(Links);

}  // namespace
}  // namespace pogosim
