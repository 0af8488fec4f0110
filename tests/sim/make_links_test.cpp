// Links of a configuration, in the world.
#include "sim/make_links.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "config/config_file.hpp"
#include "lamps/lamp_types.hpp"
#include "sim/build_world.hpp"

namespace pogosim {
namespace {

using config_file::error_of;
using config_file::Folder;
using config_file::Warnings;

constexpr float kTolerance = 0.01F;  // mm
constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kRadius = 20.0F;
constexpr float kSpacing = 60.0F;

struct Built {
    World world;
    std::string error = "no error";
    std::string warnings;

    std::vector<Link> const& links() const { return world.links; }

    Vec2 out_of_frame(std::uint32_t body, Vec2 offset) const {
        return rotate(offset, direction(world.bodies.heading_rad[body]));
    }
    Vec2 end_a(Link const& link) const {
        return world.bodies.position_mm[link.a] + out_of_frame(link.a, link.end_a_mm);
    }
    Vec2 end_b(Link const& link) const {
        return link.b == kNone ? link.end_b_mm : world.bodies.position_mm[link.b] + out_of_frame(link.b, link.end_b_mm);
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs() const {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> all;
        for (Link const& link : world.links) {
            all.emplace_back(link.a, link.b);
        }
        return all;
    }
};

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Built build(std::string const& text, std::string const& csv = "a,b\n") {
    Folder const folder;
    Warnings const warnings;
    Folder::write("links.csv", csv);
    Folder::write("x.yaml", "arena_file: arenas/square.csv\narena_surface: 4e6\n" + text);
    Built built;
    built.error = error_of([&] { built.world = build_world(load_scenario("x.yaml", {}, object_types()), 1); });
    built.warnings = warnings.text();
    return built;
}

/// Robots in a lattice, bodies 0, 1, ...
Built lattice(std::string const& kind, std::size_t count, std::string const& link, std::string const& more = "") {
    return build(
        fmt::format("initial_formation: lattice\nlattice_kind: {}\nlattice_distance_between_neighbors: {}\n"
                    "{}objects:\n  robots: {{type: pogobot, geometry: disk, radius: {}, nb: {}}}\n"
                    "links:\n  it: {}\n",
                    kind, kSpacing, more, kRadius, count, link));
}

/// Robots at these places, bodies 0, 1, ...
Built robots_at(std::string const& poses, std::string const& link, std::string const& csv = "a,b\n") {
    return build(fmt::format("objects:\n  robots: {{type: pogobot, geometry: disk, radius: {}, poses: {}}}\n"
                             "  box: {{type: passive_object, geometry: rectangle, body_width: 80, body_height: 40, x: "
                             "1000, y: 1000, angle: 0.5}}\n"
                             "links:\n  it: {}\n",
                             kRadius, poses, link),
                 csv);
}

std::string const kRow = "[[100, 500], [200, 500], [320, 500], [600, 500]]";

TEST(MakeLinks, TriangularPatchOfNShellsHasThreeNTimesThreeNPlusOneLinks) {
    for (std::size_t shells = 1; shells <= 5; ++shells) {
        std::size_t const count = 1 + 3 * shells * (shells + 1);
        Built const built = lattice("triangular", count, "{between: robots, topology: triangular}");
        ASSERT_EQ(built.error, "no error");
        EXPECT_EQ(built.links().size(), 3 * shells * (3 * shells + 1));
        for (Link const& link : built.links()) {
            EXPECT_LT(link.a, link.b);
            EXPECT_NEAR(link.length_mm, kSpacing, kTolerance);
        }
        EXPECT_TRUE(std::ranges::is_sorted(built.pairs()));
        EXPECT_EQ(built.warnings, "");
    }
}

TEST(MakeLinks, SquarePatchOfNByMHasTwoNMMinusNMinusMLinks) {
    for (std::size_t n = 2; n <= 6; ++n) {
        for (std::size_t const m : {n, n + 1}) {
            Built const built = lattice("square", n * m, "{between: robots, topology: square}");
            ASSERT_EQ(built.error, "no error");
            EXPECT_EQ(built.links().size(), 2 * n * m - n - m);
        }
    }
}

TEST(MakeLinks, LatticeWithoutASpacingOfItsOwnIsLinkedToo) {
    Built const built = build(
        "initial_formation: lattice\nobjects:\n  robots: {type: pogobot, radius: 20, nb: 7}\n"
        "  large: {type: pogobot, radius: 30, nb: 1}\n"
        "links:\n  it: {between: robots, topology: triangular}\n  to_large: {between: [robots, large], topology: "
        "triangular}\n");
    ASSERT_EQ(built.error, "no error");
    // The first one placed is the largest: it is in the middle, with a ring of six others around it; the last one
    // touches two of these.
    EXPECT_EQ(std::ranges::count(built.links(), 0U, &Link::link_category), 8);
    EXPECT_EQ(std::ranges::count(built.links(), 1U, &Link::link_category), 6);
    for (Link const& link : built.links()) {
        EXPECT_NEAR(link.length_mm, 2.02101F * 30.0F, kTolerance);
    }
}

TEST(MakeLinks, CategoriesInLatticesOfTheirOwnAreNotLinkedAcross) {
    Built const built = build(
        "lattice_distance_between_neighbors: 60\nobjects:\n  robots:\n"
        "    - {type: pogobot, radius: 20, nb: 7, initial_formation: lattice, area: {x: 500, y: 500, radius: 200}}\n"
        "    - {type: pogobot, radius: 20, nb: 7, initial_formation: lattice, area: {x: 690, y: 500, radius: 200}}\n"
        "links:\n  it: {between: robots, topology: triangular}\n");
    ASSERT_EQ(built.error, "no error");
    EXPECT_EQ(built.links().size(), 24U);
    for (Link const& link : built.links()) {
        EXPECT_EQ(link.a < 7, link.b < 7);
    }
}

TEST(MakeLinks, LatticeThatFillsAPeriodicArenaIsLinkedAcrossTheSeam) {
    // 10 x 10 nodes, 100 mm apart: four neighbours for each.
    Built const built = build(
        "arena_surface: 1e6\nboundary_condition: periodic\ninitial_formation: lattice\nlattice_kind: square\n"
        "lattice_distance_between_neighbors: 100\n"
        "objects:\n  robots: {type: pogobot, radius: 20, nb: 100}\nlinks:\n  it: {between: robots, topology: "
        "square}\n");
    ASSERT_EQ(built.error, "no error");
    EXPECT_EQ(built.links().size(), 200U);
    for (Link const& link : built.links()) {
        EXPECT_NEAR(link.length_mm, 100.0F, kTolerance);
    }
}

TEST(MakeLinks, ChainsAndRingsFollowTheNumbersOrTheOrderOfTheList) {
    EXPECT_EQ(robots_at(kRow, "{between: robots, topology: chain}").pairs(), (Pairs{{0, 1}, {1, 2}, {2, 3}}));
    EXPECT_EQ(robots_at(kRow, "{between: robots, topology: ring}").pairs(), (Pairs{{0, 1}, {1, 2}, {2, 3}, {3, 0}}));
    EXPECT_EQ(robots_at(kRow, "{between: robots, topology: chain, which: [3, 0, 2]}").pairs(), (Pairs{{3, 0}, {0, 2}}));
    Built const built = robots_at(kRow, "{between: robots, topology: chain}");
    EXPECT_FLOAT_EQ(built.links()[0].length_mm, 100.0F);
    EXPECT_FLOAT_EQ(built.links()[1].length_mm, 120.0F);
    EXPECT_FLOAT_EQ(built.links()[2].length_mm, 280.0F);
}

TEST(MakeLinks, NearestOnesAreLinkedOnceHoweverOftenTheyChooseEachOther) {
    EXPECT_EQ(robots_at(kRow, "{between: robots, topology: nearest, neighbors: 1}").pairs(),
              (Pairs{{0, 1}, {1, 2}, {2, 3}}));
    EXPECT_EQ(robots_at(kRow, "{between: robots, topology: nearest, neighbors: 2}").pairs(),
              (Pairs{{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}}));
    EXPECT_EQ(robots_at(kRow, "{between: robots, topology: nearest}").links().size(), 6U);
    EXPECT_EQ(robots_at(kRow, "{between: robots, topology: nearest, max_distance: 110}").pairs(), (Pairs{{0, 1}}));
    EXPECT_EQ(robots_at(kRow, "{between: [box, robots], topology: nearest, neighbors: 2}").pairs(),
              (Pairs{{4, 2}, {4, 3}}));
    Built const none = robots_at(kRow, "{between: robots, topology: nearest, max_distance: 50}");
    EXPECT_TRUE(none.links().empty());
    EXPECT_NE(none.warnings.find("links.it.topology: there are no such pairs of objects, so no links are made"),
              std::string::npos)
        << none.warnings;
}

TEST(MakeLinks, NearestOnesOfManyAreThoseOfALookAtAll) {
    for (std::string const boundary : {"solid", "periodic"}) {
        Built const built = build("boundary_condition: " + boundary +
                                  "\ninitial_formation: random\nobjects:\n  robots: {type: pogobot, radius: 20, nb: "
                                  "300}\nlinks:\n  it: {between: robots, topology: nearest, neighbors: 4}\n");
        ASSERT_EQ(built.error, "no error");
        std::set<std::pair<std::uint32_t, std::uint32_t>> expected;
        auto const& places = built.world.bodies.position_mm;
        for (std::uint32_t i = 0; i < places.size(); ++i) {
            std::vector<std::pair<float, std::uint32_t>> others;
            for (std::uint32_t j = 0; j < places.size(); ++j) {
                if (i != j) {
                    others.emplace_back(squared_length(minimum_image(built.world, places[i], places[j])), j);
                }
            }
            std::ranges::sort(others);
            for (std::size_t k = 0; k < 4; ++k) {
                expected.insert(std::minmax(i, others[k].second));
            }
        }
        EXPECT_EQ(built.pairs(), Pairs(expected.begin(), expected.end())) << boundary;
    }
}

TEST(MakeLinks, LinksAcrossTheSeamOfAPeriodicArenaAreAsShortAsTheyCanBe) {
    Built const built = build(
        "boundary_condition: periodic\nobjects:\n  robots: {type: pogobot, radius: 20, poses: [[100, 500, 1], [1900, "
        "500, 2]]}\nlinks:\n  it: {between: robots, topology: chain}\n  pin: {type: hinge, between: robots, topology: "
        "chain}\n");
    ASSERT_EQ(built.error, "no error");
    EXPECT_NEAR(built.links()[0].length_mm, 200.0F, kTolerance);
    Link const& hinge = built.links()[1];
    EXPECT_NEAR(length(built.end_a(hinge) - Vec2{0, 500}), 0.0F, kTolerance);
    EXPECT_NEAR(length(built.end_b(hinge) - Vec2{2000, 500}), 0.0F, kTolerance);
}

TEST(MakeLinks, ListIsReadWithLengthsOrWithout) {
    std::string const link = "{between: robots, topology: list, file: links.csv}";
    Built const built = robots_at(kRow, link, "# the skeleton\nb,a,length\n1,0,90\n\n3,0,\n");
    ASSERT_EQ(built.error, "no error");
    EXPECT_EQ(built.pairs(), (Pairs{{0, 1}, {0, 3}}));
    EXPECT_FLOAT_EQ(built.links()[0].length_mm, 90.0F);
    EXPECT_FLOAT_EQ(built.links()[1].length_mm, 500.0F);
    EXPECT_EQ(robots_at(kRow, link, "0,1\n2,1\n").pairs(), (Pairs{{0, 1}, {2, 1}}));
    EXPECT_EQ(robots_at(kRow, "{between: [robots, box], topology: list, file: links.csv}", "a,b\n2,0\n").pairs(),
              (Pairs{{2, 4}}));
}

TEST(MakeLinks, MistakesInAListAreToldWithFileAndLine) {
    auto const error = [](std::string const& csv) {
        return robots_at(kRow, "{between: robots, topology: list, file: links.csv}", csv).error;
    };
    EXPECT_EQ(error("a,b\n0,4\n"), "links.csv:2: b: expected the number of an object, 0 to 3, found 4");
    EXPECT_EQ(error("a,b\n0,1.5\n"), "links.csv:2: b: expected the number of an object, 0 to 3, found 1.5");
    EXPECT_EQ(error("a,b\n-1,1\n"), "links.csv:2: a: expected the number of an object, 0 to 3, found -1");
    EXPECT_EQ(error("a,b\n0,x\n"), "links.csv:2: b: expected a number, found 'x'");
    EXPECT_EQ(error("a,b\n0,1\n1,0\n"), "links.csv:3: links objects 1 and 0 a second time");
    EXPECT_EQ(error("a,b\n2,2\n"), "links.csv:2: links object 2 to itself");
    EXPECT_EQ(error("a,c\n0,1\n"),
              "links.csv:1: expected a header with the columns a, b and optionally length, found 'c'");
    EXPECT_EQ(error("a,a\n0,1\n"),
              "links.csv:1: expected a header with the columns a, b and optionally length, found 'a' twice");
    EXPECT_EQ(error("a,length\n0,1\n"),
              "links.csv:1: expected a header with the columns a, b and optionally length, found no b");
    EXPECT_EQ(error("a,b\n0,1,2\n"), "links.csv:2: expected 2 fields between commas, found 3");
    EXPECT_EQ(error("0\n"),
              "links.csv:1: expected the columns a, b and optionally length, found 1 fields between commas");
    EXPECT_EQ(error("a,b\n"), "links.csv: no rows; expected the columns a, b and optionally length");
    EXPECT_EQ(error("a,b,length\n0,1,-3\n"), "links.csv:2: length: expected a number from 0 to 1000000 (mm), found -3");
    EXPECT_EQ(
        robots_at(kRow, "{type: hinge, between: robots, topology: list, file: links.csv}", "a,b,length\n0,1,3\n").error,
        "links.csv:2: a hinge has no length; leave the column out");
}

TEST(MakeLinks, FixedLinksHoldObjectsWhereTheyAre) {
    Built const built = robots_at("[[100, 500, 0.5], [200, 500, 2]]", "{between: robots, topology: fixed}");
    ASSERT_EQ(built.links().size(), 2U);
    for (Link const& link : built.links()) {
        EXPECT_EQ(link.b, kNone);
        EXPECT_EQ(link.end_a_mm, Vec2{});
        EXPECT_EQ(link.end_b_mm, built.world.bodies.position_mm[link.a]);
        EXPECT_EQ(link.length_mm, 0.0F);
    }
    Built const ahead = robots_at("[[100, 500, 1.5707964], [200, 500, 2]]",
                                  "{between: robots, topology: fixed, attach: [20, 5], which: [0]}");
    ASSERT_EQ(ahead.links().size(), 1U);
    EXPECT_EQ(ahead.links()[0].end_a_mm, (Vec2{20.0F, 5.0F}));
    EXPECT_EQ(ahead.links()[0].length_mm, 0.0F);
    // Ahead is down on the screen, so its right is to the left.
    EXPECT_NEAR(length(ahead.links()[0].end_b_mm - Vec2{95.0F, 520.0F}), 0.0F, kTolerance);
}

TEST(MakeLinks, RimOfALatticeIsItsLastShell) {
    Built const built = lattice("triangular", 37, "{between: robots, topology: fixed, which: rim}");
    ASSERT_EQ(built.links().size(), 18U);
    for (Link const& link : built.links()) {
        EXPECT_GE(link.a, 19U);
    }
    EXPECT_EQ(lattice("square", 20, "{between: robots, topology: fixed, which: rim}").links().size(), 14U);
}

TEST(MakeLinks, FixedPlacesMayBeInAFile) {
    std::string const link = "between: robots, topology: fixed, file: links.csv";
    Built const built = robots_at(kRow, "{" + link + ", attach: rim}", "a,x,y\n1,200,600\n");
    ASSERT_EQ(built.error, "no error");
    ASSERT_EQ(built.links().size(), 1U);
    EXPECT_EQ(built.links()[0].a, 1U);
    EXPECT_EQ(built.links()[0].end_b_mm, (Vec2{200, 600}));
    EXPECT_NEAR(built.links()[0].length_mm, 100.0F - kRadius, kTolerance);
    EXPECT_NEAR(length(built.end_a(built.links()[0]) - Vec2{200.0F, 500.0F + kRadius}), 0.0F, kTolerance);
    Built const hinge = robots_at(kRow, "{type: hinge, " + link + "}", "a,x,y\n1,200,600\n");
    ASSERT_EQ(hinge.links().size(), 1U);
    EXPECT_NEAR(length(hinge.end_a(hinge.links()[0]) - Vec2{200, 600}), 0.0F, kTolerance);
    EXPECT_EQ(robots_at(kRow, "{" + link + "}", "a,x,y\n1,0,0\n1,5,5\n").error,
              "links.csv:3: holds object 1 a second time");
    EXPECT_EQ(robots_at(kRow, "{" + link + "}", "a,x,y\n9,0,0\n").error,
              "links.csv:2: a: expected the number of an object, 0 to 3, found 9");
}

TEST(MakeLinks, RodThatDoesNotFitIsRefused) {
    EXPECT_EQ(
        robots_at("[[100, 500], [160, 500]]", "{type: rod, between: robots, topology: chain, rest_length: 60.5}").error,
        "no error");
    EXPECT_EQ(
        robots_at("[[100, 500], [160, 500]]", "{type: rod, between: robots, topology: chain, rest_length: 90}").error,
        "x.yaml:7: links.it.rest_length: the rod of robots 0 and robots 1 is to be 90 mm long, but its ends are 60 "
        "mm apart at the start");
    EXPECT_EQ(
        robots_at("[[100, 500], [160, 500]]", "{type: rod, between: robots, topology: list, file: links.csv}",
                  "a,b,length\n0,1,70\n")
            .error,
        "x.yaml:7: links.it.file: the rod of robots 0 and robots 1 is to be 70 mm long, but its ends are 60 mm apart "
        "at the start");
}

TEST(MakeLinks, FixedPlacesMayBeAcrossTheSeam) {
    Built const built =
        build(fmt::format("boundary_condition: periodic\n"
                          "objects:\n  robots: {{type: pogobot, geometry: disk, radius: {}, poses: [[40, "
                          "500]]}}\nlinks:\n  it: {{between: robots, topology: fixed, file: links.csv}}\n",
                          kRadius),
              "a,x,y\n0,1960,500\n");
    ASSERT_EQ(built.error, "no error");
    EXPECT_NEAR(built.links().at(0).length_mm, 80.0F, kTolerance);
}

TEST(MakeLinks, RimIsThePointOfTheOutlineTowardsTheOtherEnd) {
    Built const disks =
        robots_at("[[100, 500, 0.7], [200, 500, -2]]", "{between: robots, topology: chain, attach: rim}");
    Link const& link = disks.links().at(0);
    EXPECT_NEAR(length(disks.end_a(link) - Vec2{100.0F + kRadius, 500}), 0.0F, kTolerance);
    EXPECT_NEAR(length(disks.end_b(link) - Vec2{200.0F - kRadius, 500}), 0.0F, kTolerance);
    EXPECT_NEAR(link.length_mm, 100.0F - 2.0F * kRadius, kTolerance);
    // The box of 80 x 40 mm is turned by 0.5 rad; seen from it, the robot is straight ahead, then to its right.
    for (float const turn : {0.0F, 0.5F * kPi}) {
        Vec2 const place = Vec2{1000, 1000} + 200.0F * direction(0.5F + turn);
        Built const built = robots_at(fmt::format("[[{}, {}]]", place.x, place.y),
                                      "{between: [robots, box], topology: nearest, attach: rim}");
        Link const& to_box = built.links().at(0);
        EXPECT_NEAR(length(to_box.end_b_mm - (turn == 0.0F ? Vec2{40, 0} : Vec2{0, 20})), 0.0F, kTolerance);
        EXPECT_NEAR(to_box.length_mm, 200.0F - kRadius - (turn == 0.0F ? 40.0F : 20.0F), kTolerance);
    }
}

TEST(MakeLinks, HingesMeetInTheMiddleOfBothCentres) {
    Built const built = robots_at("[[100, 500, 0.25], [200, 540, -3]]",
                                  "{type: hinge, between: robots, topology: chain, limits: [-30, 60]}");
    Link const& link = built.links().at(0);
    EXPECT_NEAR(length(built.end_a(link) - Vec2{150, 520}), 0.0F, kTolerance);
    EXPECT_NEAR(length(built.end_b(link) - Vec2{150, 520}), 0.0F, kTolerance);
    EXPECT_EQ(link.length_mm, 0.0F);
    EXPECT_NEAR(link.rest_rad, 2.0F * kPi - 3.25F, 1e-5F);
    EXPECT_NEAR(link.least_rad, -kPi / 6.0F, 1e-5F);
    EXPECT_NEAR(link.most_rad, kPi / 3.0F, 1e-5F);
    Built const free = robots_at("[[100, 500], [200, 540]]", "{type: hinge, between: robots, topology: chain}");
    EXPECT_TRUE(std::isinf(free.links().at(0).least_rad) && std::isinf(free.links().at(0).most_rad));
    Built const pinned = robots_at("[[100, 500, 0.25]]", "{type: hinge, between: robots, topology: fixed}");
    EXPECT_NEAR(pinned.links().at(0).rest_rad, -0.25F, 1e-6F);
}

TEST(MakeLinks, NumbersOfAnEntryAreThoseOfItsLinks) {
    Built const built =
        robots_at(kRow,
                  "{between: robots, topology: chain, rest_length: 70, stiffness: 3, damping: 0.5, "
                  "breaking_force: 2, visible: false}\n  rods: {type: rod, between: robots, topology: ring}");
    ASSERT_EQ(built.error, "no error");
    ASSERT_EQ(built.world.link_categories.size(), 2U);
    EXPECT_EQ(built.world.link_categories[0].name, "it");
    EXPECT_FALSE(built.world.link_categories[0].are_drawn);
    EXPECT_EQ(built.world.link_categories[1].name, "rods");
    EXPECT_TRUE(built.world.link_categories[1].are_drawn);
    ASSERT_EQ(built.links().size(), 7U);
    Link const& spring = built.links()[0];
    EXPECT_EQ(spring.kind, LinkKind::spring);
    EXPECT_EQ(spring.length_mm, 70.0F);
    EXPECT_EQ(spring.stiffness_n_m, 3.0F);
    EXPECT_EQ(spring.damping_n_s_m, 0.5F);
    EXPECT_EQ(spring.breaking_n, 2.0F);
    EXPECT_EQ(spring.link_category, 0U);
    Link const& rod = built.links()[3];
    EXPECT_EQ(rod.kind, LinkKind::rod);
    EXPECT_EQ(rod.stiffness_n_m, 0.0F);
    EXPECT_TRUE(std::isinf(rod.breaking_n));
    EXPECT_EQ(rod.link_category, 1U);
}

TEST(MakeLinks, BodiesThatCannotMoveAreNotLinkedToEachOther) {
    std::string const objects =
        "objects:\n  it:\n    - {type: passive_object, geometry: disk, x: 100, y: 100, body_fixed: true}\n"
        "    - {type: passive_object, geometry: disk, x: 200, y: 100, body_fixed: true}\n"
        "    - {type: passive_object, geometry: disk, x: 300, y: 100}\n";
    EXPECT_EQ(build(objects + "links: {a: {between: it, topology: chain}}\n").pairs(), (Pairs{{1, 2}}));
    EXPECT_EQ(build(objects + "links: {a: {between: it, topology: fixed}}\n").links().size(), 1U);
}

TEST(MakeLinks, RodWithoutALengthIsRefused) {
    Built const built =
        robots_at("[[100, 500], [140, 500]]", "{type: rod, between: robots, topology: chain, attach: rim}");
    EXPECT_EQ(built.error,
              "x.yaml:7: links.it.type: the rod of robots 0 and robots 1 would have no length; use a hinge");
}

}  // namespace
}  // namespace pogosim
