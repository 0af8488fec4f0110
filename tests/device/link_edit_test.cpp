// Links that are made and cut while a run goes on.
#include "device/link_edit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>

#include "base/error.hpp"
#include "support/small_world.hpp"
#include "world/link_places.hpp"

namespace pogosim {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kQuarterTurn = 0.5F * std::numbers::pi_v<float>;

/// Three robots, a wall without a body, a membrane of two bodies and two fixed bodies: objects 0 to 6.
World linkable_world() {
    World world = testing::square_world();
    testing::add_robot(world, {100, 100});
    testing::add_robot(world, {200, 100}, kQuarterTurn);
    testing::add_robot(world, {950, 500});
    world.objects.push_back({.id = 3});
    ObjectSpec fixed = testing::pogobot_spec();
    fixed.body->fixed = true;
    for (int i = 0; i < 2; ++i) {
        testing::add_body(world, {500, 500}, 0.0F, testing::pogobot_spec());
    }
    world.objects.push_back({.id = 4, .body = 3, .body_count = 2});
    for (std::uint32_t i = 0; i < 2; ++i) {
        std::uint32_t const body = testing::add_body(world, {700, 700}, 0.0F, fixed);
        world.objects.push_back({.id = 5 + i, .body = body, .body_count = 1});
    }
    return world;
}

NewLink spring_between(World const& world, std::uint32_t a, std::uint32_t b) {
    NewLink link = link_between(world, LinkKind::spring, a, b);
    link.stiffness_n_m = 2.0F;
    return link;
}

TEST(LinkEdit, SpringIsAsLongAtRestAsItsEndsAreApart) {
    World world = linkable_world();
    NewLink link = spring_between(world, 0, 1);
    EXPECT_EQ(add_link(world, link), 0U);
    link.length_mm = 30.0F;
    EXPECT_EQ(add_link(world, link), 1U);
    EXPECT_EQ(world.links[0].length_mm, 100.0F);
    EXPECT_EQ(world.links[1].length_mm, 30.0F);
    EXPECT_EQ(world.links[0].stiffness_n_m, 2.0F);
    EXPECT_EQ(world.links[0].breaking_n, kInfinite);
    EXPECT_EQ(world.link_changes, 2U);
    EXPECT_EQ(world.link_categories, (std::vector<LinkCategory>{{.name = kMadeLinks, .are_drawn = true}}));
}

TEST(LinkEdit, EndsTurnWithTheirBodies) {
    World world = linkable_world();
    NewLink link = link_between(world, LinkKind::rod, 0, 1);
    link.end_a_mm = {26.5F, 0.0F};
    link.end_b_mm = {0.0F, 26.5F};  // to the right of a robot that heads down: on its left side of the screen
    add_link(world, link);
    LinkPlaces const ends = places_of_ends(world, world.links[0]);
    EXPECT_NEAR(ends.a_mm.x, 126.5F, 1e-4F);
    EXPECT_NEAR(ends.b_mm.x, 173.5F, 1e-4F);
    EXPECT_NEAR(ends.b_mm.y, 100.0F, 1e-4F);
    EXPECT_NEAR(world.links[0].length_mm, 47.0F, 1e-4F);
}

TEST(LinkEdit, HingeIsHalfwayBetweenItsObjectsAndKnowsTheirAngle) {
    World world = linkable_world();
    add_link(world, link_between(world, LinkKind::hinge, 0, 1));
    Link const& hinge = world.links[0];
    LinkPlaces const ends = places_of_ends(world, hinge);
    EXPECT_NEAR(ends.a_mm.x, 150.0F, 1e-4F);
    EXPECT_NEAR(ends.a_mm.y, 100.0F, 1e-4F);
    EXPECT_NEAR(length(ends.span_mm()), 0.0F, 1e-4F);
    EXPECT_NEAR(hinge.rest_rad, kQuarterTurn, 1e-6F);
    EXPECT_EQ(hinge.length_mm, 0.0F);
}

TEST(LinkEdit, LinkToTheArenaIsWhereItsObjectIs) {
    World world = linkable_world();
    NewLink link = spring_between(world, 2, kNone);
    EXPECT_EQ(link.end_b_mm, (Vec2{950, 500}));
    link.end_b_mm = {900, 500};
    add_link(world, link);
    EXPECT_EQ(world.links[0].b, kNone);
    EXPECT_EQ(world.links[0].length_mm, 50.0F);
}

TEST(LinkEdit, LinkAcrossTheSeamTakesTheShortWay) {
    World world = linkable_world();
    world.periodic = true;
    world.bodies.position_mm[0] = {20, 500};
    add_link(world, spring_between(world, 0, 2));
    EXPECT_NEAR(world.links[0].length_mm, 70.0F, 1e-4F);
    add_link(world, link_between(world, LinkKind::hinge, 0, 2));
    EXPECT_NEAR(places_of_ends(world, world.links[1]).a_mm.x, -15.0F, 1e-4F);
}

TEST(LinkEdit, CutLinkKeepsItsPlaceAndCountsOnce) {
    World world = linkable_world();
    add_link(world, spring_between(world, 0, 1));
    world.links[0].tension_n = 3.0F;
    cut_link(world, 0);
    cut_link(world, 0);
    EXPECT_TRUE(world.links[0].is_cut);
    EXPECT_EQ(world.links[0].tension_n, 0.0F);
    EXPECT_EQ(world.link_changes, 2U);
    EXPECT_EQ(add_link(world, spring_between(world, 0, 2)), 1U);
}

TEST(LinkEdit, ObjectsAreFoundByTheirBodies) {
    World const world = linkable_world();
    EXPECT_EQ(objects_of_bodies(world), (std::vector<std::uint32_t>{0, 1, 2, 4, 4, 5, 6}));
    EXPECT_EQ(object_of_body(world, 4), 4U);
    EXPECT_EQ(object_of_body(world, 6), 6U);
    EXPECT_EQ(object_of_body(world, kNone), kNone);
}

std::string refusal(std::function<void(World& world)> const& edit) {
    World world = linkable_world();
    World const before = world;
    try {
        edit(world);
    } catch (ConfigError const& error) {
        EXPECT_EQ(world, before) << error.what();
        return error.what();
    }
    return "";
}

std::string refusal_between(std::uint32_t a, std::uint32_t b) {
    return refusal([=](World& world) { add_link(world, {.a = a, .b = b, .stiffness_n_m = 1.0F}); });
}

TEST(LinkEdit, RefusesObjectsThatCannotBeLinked) {
    EXPECT_EQ(refusal_between(0, 0), "object 0 cannot be linked to itself");
    EXPECT_EQ(refusal_between(0, 9), "there is no object 9: the run has 7");
    EXPECT_EQ(refusal_between(9, kNone), "there is no object 9: the run has 7");
    EXPECT_EQ(refusal_between(0, 3), "object 3 of category 'robots' has no body that could be linked");
    EXPECT_EQ(refusal_between(4, 0), "object 4 of category 'robots' is a membrane, which cannot be linked");
    EXPECT_EQ(refusal_between(5, 6), "objects 5 and 6 are fixed: a link would hold nothing");
    EXPECT_EQ(refusal_between(5, kNone), "object 5 is fixed: a link to the arena would hold nothing");
    EXPECT_EQ(refusal_between(5, 0), "");
    EXPECT_EQ(refusal([](World& world) { link_between(world, LinkKind::rod, 1, 1); }),
              "object 1 cannot be linked to itself");
    EXPECT_EQ(refusal([](World& world) { cut_link(world, 0); }), "there is no link 0: the run has none");
}

std::string refusal_of(LinkKind kind, std::function<void(NewLink& link)> const& change) {
    return refusal([&](World& world) {
        NewLink link = link_between(world, kind, 0, 1);
        link.stiffness_n_m = kind == LinkKind::spring ? 1.0F : 0.0F;
        change(link);
        add_link(world, link);
    });
}

TEST(LinkEdit, RefusesNumbersOutOfRange) {
    auto const spring = LinkKind::spring;
    EXPECT_EQ(refusal_of(spring, [](NewLink& link) { link.stiffness_n_m = -1.0F; }),
              "stiffness: expected a number from 0 to 1e+09, found -1");
    EXPECT_EQ(refusal_of(spring, [](NewLink& link) { link.stiffness_n_m = 0.0F; }),
              "stiffness: a spring without stiffness and damping would do nothing");
    EXPECT_EQ(refusal_of(spring, [](NewLink& link) { link.stiffness_n_m = kInfinite; }),
              "stiffness: expected a number from 0 to 1e+09, found inf");
    EXPECT_EQ(refusal_of(spring, [](NewLink& link) { link.damping_n_s_m = kNan; }),
              "damping: expected a number from 0 to 1e+09, found nan");
    EXPECT_EQ(refusal_of(spring, [](NewLink& link) { link.breaking_n = 0.0F; }),
              "breaking force: expected a number above 0, found 0");
    EXPECT_EQ(refusal_of(spring, [](NewLink& link) { link.length_mm = -2.0F; }),
              "length: expected a number from 0 to 1e+06, found -2");
    EXPECT_EQ(refusal_of(spring, [](NewLink& link) { link.end_a_mm.y = kNan; }),
              "end_a: expected finite numbers up to 1e+06, found (0, nan)");
    EXPECT_EQ(refusal_of(spring, [](NewLink& link) { link.most_rad = 1.0F; }), "limits: only hinges have some");
    EXPECT_EQ(refusal_of(LinkKind::hinge, [](NewLink& link) { link.least_rad = 0.5F; }),
              "least angle: expected a number of at most 0, found 0.5");
    EXPECT_EQ(refusal_of(LinkKind::hinge, [](NewLink& link) { link.most_rad = -0.5F; }),
              "greatest angle: expected a number of at least 0, found -0.5");
}

TEST(LinkEdit, RefusesRodsAndHingesThatTheirEndsDoNotFit) {
    EXPECT_EQ(refusal_of(LinkKind::rod, [](NewLink& link) { link.length_mm = 98.0F; }),
              "length: a rod of 98 mm does not fit ends that are 100 mm apart");
    EXPECT_EQ(refusal_of(LinkKind::rod, [](NewLink& link) { link.length_mm = 99.5F; }), "");
    EXPECT_EQ(refusal_of(LinkKind::rod, [](NewLink& link) { link.length_mm = 0.0F; }),
              "length: expected a number above 0 for a rod, found 0; a hinge holds two ends together");
    EXPECT_EQ(refusal_of(LinkKind::rod, [](NewLink& link) { link.stiffness_n_m = 1.0F; }),
              "stiffness: expected 0, as only springs have one, found 1");
    EXPECT_EQ(refusal_of(LinkKind::hinge, [](NewLink& link) { link.end_a_mm = {}; }),
              "the ends of a hinge have to be in one place, and these are 50 mm apart");
    EXPECT_EQ(refusal_of(LinkKind::hinge, [](NewLink& link) { link.length_mm = 5.0F; }), "length: a hinge has none");
}

}  // namespace
}  // namespace pogosim
