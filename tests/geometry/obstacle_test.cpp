#include "geometry/obstacle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "geometry/formation.hpp"

namespace pogosim {
namespace {

constexpr float kRobotRadius = 26.5F;
constexpr float kTolerance = 0.01F;  // mm

Shape const kDisk{.kind = ShapeKind::disk, .radius_mm = 100.0F};
Shape const kBox{.kind = ShapeKind::rectangle, .width_mm = 200.0F, .height_mm = 100.0F};
Shape const kTriangle{.kind = ShapeKind::triangle, .side_length_mm = 200.0F};

Obstacle solid(Shape const& shape, Vec2 position_mm, float heading_rad = 0.0F) {
    return solid_obstacles("'thing'", shape, position_mm, heading_rad).front();
}

/// A ring of dots of radius 10 mm through this circle.
Obstacle ring(float radius_mm, Vec2 centre_mm) {
    Shape const circle{.kind = ShapeKind::disk, .radius_mm = radius_mm};
    return {.name = "'ring'",
            .line = moved(outline(circle, 80), centre_mm, 0.0F),
            .half_thickness_mm = 10.0F,
            .solid = false};
}

Arena square(float side_mm) {
    return make_arena({{{0, 0}, {side_mm, 0}, {side_mm, side_mm}, {0, side_mm}}});
}

/// 2 x 2 m with a pillar of 400 x 400 mm.
Arena const kHall = make_arena(
    {{{0, 0}, {2000, 0}, {2000, 2000}, {0, 2000}}, {{1200, 1200}, {1600, 1200}, {1600, 1600}, {1200, 1600}}});

/// All that may go wrong: solids over each other, over the outer wall, its corner and the pillar; rings alone, with a
/// solid in it, over a solid; all windings.
std::vector<Obstacle> furniture() {
    std::vector<Obstacle> things{
        solid(kBox, {400, 400}),
        solid(kBox, {450, 420}, 1.0F),
        solid(kDisk, {500, 350}),
        solid(kTriangle, {1000, 10}, 0.3F),
        solid({.kind = ShapeKind::rectangle, .width_mm = 300.0F, .height_mm = 300.0F}, {1980, 1980}),
        solid({.kind = ShapeKind::rectangle, .width_mm = 300.0F, .height_mm = 300.0F}, {1200, 1400}),
        ring(300.0F, {500, 1400}),
        solid(kTriangle, {500, 1400}),
        ring(150.0F, {1500, 500}),
        solid(kDisk, {1650, 500}),
    };
    std::ranges::reverse(things[1].line);
    std::ranges::reverse(things[6].line);
    return things;
}

FormationSpec named(std::string const& name) {
    FormationSpec spec;
    spec.name = name;
    spec.chessboard_pitch_mm = 60.0F;
    return spec;
}

std::vector<Placement> place_seeded(FormationSpec const& spec, std::span<float const> radii,
                                    FormationGround const& ground, std::uint64_t seed = 1) {
    RandomStream random(seed, 5);
    return place(spec, radii, ground, random);
}

void expect_legal(std::vector<Placement> const& placements, std::span<float const> radii,
                  FormationGround const& ground) {
    ASSERT_EQ(placements.size(), radii.size());
    for (std::size_t i = 0; i < placements.size(); ++i) {
        Vec2 const place = placements[i].position_mm;
        ASSERT_TRUE(ground.domain.contains(place)) << i;
        ASSERT_GE(ground.domain.distance_to_walls(place), radii[i] - kTolerance) << i;
        for (std::size_t k = 0; k < ground.obstacles.size(); ++k) {
            ASSERT_GE(gap_mm(ground.obstacles[k], place), radii[i] - kTolerance) << i << " at obstacle " << k;
        }
        for (std::size_t j = 0; j < i; ++j) {
            ASSERT_GE(length(place - placements[j].position_mm), radii[i] + radii[j] - kTolerance) << i << ", " << j;
        }
    }
}

// ---- Gaps and overlaps ----------------------------------------------------------------------------------------------

TEST(Obstacle, GapIsTheDistanceToItAndNegativeInside) {
    EXPECT_FLOAT_EQ(gap_mm(solid(kDisk, {500, 500}), {800, 900}), 400.0F);
    EXPECT_FLOAT_EQ(gap_mm(solid(kDisk, {500, 500}), {500, 470}), -70.0F);
    EXPECT_FLOAT_EQ(gap_mm(solid(kBox, {500, 500}), {630, 590}), 50.0F);  // 30 and 40 from its corner
    EXPECT_FLOAT_EQ(gap_mm(solid(kBox, {500, 500}), {500, 520}), -30.0F);
    EXPECT_NEAR(gap_mm(solid(kBox, {500, 500}, 0.5F * std::numbers::pi_v<float>), {560, 500}), 10.0F, 1e-3F);
    // A triangle's inscribed circle has the radius side / (2 sqrt 3).
    EXPECT_NEAR(gap_mm(solid(kTriangle, {500, 500}), {500, 500}), -200.0F / (2.0F * std::sqrt(3.0F)), 1e-3F);
}

TEST(Obstacle, RingIsABandAndItsInsideIsFree) {
    Obstacle const band = ring(200.0F, {500, 500});
    EXPECT_NEAR(gap_mm(band, {500, 500}), 190.0F, 0.2F);
    EXPECT_NEAR(gap_mm(band, {695, 500}), -5.0F, 0.2F);
    EXPECT_NEAR(gap_mm(band, {730, 500}), 20.0F, 0.2F);
}

TEST(Obstacle, OverlapIsHowDeepTwoReachIntoEachOther) {
    EXPECT_FLOAT_EQ(overlap_mm(solid(kDisk, {0, 0}), solid(kDisk, {170, 0})), 30.0F);
    EXPECT_EQ(overlap_mm(solid(kDisk, {0, 0}), solid(kDisk, {201, 0})), 0.0F);
    EXPECT_NEAR(overlap_mm(solid(kBox, {0, 0}), solid(kDisk, {190, 0})), 10.0F, 0.1F);
    EXPECT_NEAR(overlap_mm(solid(kBox, {0, 0}), solid(kBox, {180, 0})), 20.0F, 0.1F);
    EXPECT_NEAR(overlap_mm(solid(kDisk, {0, 0}), solid(kDisk, {0, 0})), 200.0F, 0.1F);
    // A ring around something does not touch it; one across it does.
    EXPECT_EQ(overlap_mm(ring(200.0F, {0, 0}), solid(kBox, {0, 0})), 0.0F);
    EXPECT_GT(overlap_mm(ring(200.0F, {0, 0}), solid(kBox, {200, 0})), 10.0F);
    EXPECT_NEAR(overlap_mm(ring(200.0F, {0, 0}), ring(200.0F, {150, 0})), 20.0F, 5.0F);
}

TEST(Obstacle, OverlapWithAnArenaIsHowDeepItReachesIntoAWall) {
    Arena const arena = square(1000.0F);
    EXPECT_EQ(overlap_mm(solid(kBox, {500, 500}), arena), 0.0F);
    EXPECT_NEAR(overlap_mm(solid(kBox, {70, 500}), arena), 30.0F, 0.1F);
    EXPECT_NEAR(overlap_mm(solid(kDisk, {70, 500}), arena), 30.0F, 0.1F);
    EXPECT_NEAR(overlap_mm(ring(150.0F, {100, 500}), arena), 60.0F, 0.5F);
    // A pillar inside of it: 200 mm from its corners to its border.
    Shape const large{.kind = ShapeKind::rectangle, .width_mm = 800.0F, .height_mm = 800.0F};
    EXPECT_NEAR(overlap_mm(solid(large, {1400, 1400}), kHall), 200.0F, 0.1F);
}

// ---- Formations -----------------------------------------------------------------------------------------------------

class FormationAmongObstacles : public testing::TestWithParam<std::string> {};

TEST_P(FormationAmongObstacles, KeepsOffThemAllAndOffTheWalls) {
    std::vector<Obstacle> const things = furniture();
    for (std::uint64_t const seed : {1, 2, 3}) {
        for (std::size_t const count : {1, 20, 150}) {
            std::vector<float> radii(count, kRobotRadius);
            if (count > 1) {
                radii[count / 2] = 60.0F;
            }
            expect_legal(place_seeded(named(GetParam()), radii, {kHall, things}, seed), radii, {kHall, things});
        }
    }
}

TEST_P(FormationAmongObstacles, SmallThingsFindNoWayInto) {
    // So many that every pocket has some: an overlap of two that counted as free would, too.
    std::vector<Obstacle> const things = furniture();
    std::vector<float> const radii(1500, 2.0F);
    FormationSpec spec = named(GetParam());
    spec.chessboard_pitch_mm = 20.0F;
    spec.cluster_at_centre = false;
    expect_legal(place_seeded(spec, radii, {kHall, things}), radii, {kHall, things});
}

TEST_P(FormationAmongObstacles, WhatStandsElsewhereChangesNothing) {
    std::vector<Obstacle> const elsewhere{solid(kBox, {-150, 500}), ring(900.0F, {500, 500}),
                                          solid(kDisk, {1500, 500})};
    Arena const arena = square(1000.0F);
    std::vector<float> const radii(60, kRobotRadius);
    auto const alone = place_seeded(named(GetParam()), radii, {arena});
    auto const beside = place_seeded(named(GetParam()), radii, {arena, elsewhere});
    for (std::size_t i = 0; i < radii.size(); ++i) {
        EXPECT_EQ(alone[i].position_mm, beside[i].position_mm);
        EXPECT_EQ(alone[i].heading_rad, beside[i].heading_rad);
    }
}

TEST_P(FormationAmongObstacles, MoreThanTheFreeAreaIsRefusedAtOnce) {
    // Half of the arena is a box; 400 robots with their spacing cover 90 % of the whole.
    Shape const half{.kind = ShapeKind::rectangle, .width_mm = 500.0F, .height_mm = 1000.0F};
    std::vector<Obstacle> const things{solid(half, {250, 500})};
    Arena const arena = square(1000.0F);
    try {
        place_seeded(named(GetParam()), std::vector<float>(400, kRobotRadius), {arena, things});
        FAIL() << "placed";
    } catch (ConfigError const& error) {
        std::string const message = error.what();
        EXPECT_NE(message.find("only about 500000 mm2 of the arena is free"), std::string::npos) << message;
    }
}

INSTANTIATE_TEST_SUITE_P(Formation, FormationAmongObstacles,
                         testing::Values("random", "aligned_random", "random_near_walls", "aligned_random_near_walls",
                                         "disk", "aligned_disk", "lloyd", "power_lloyd", "chessboard",
                                         "aligned_chessboard"),
                         [](auto const& info) { return info.param; });

TEST(FormationAmongObstacles, RandomOnesStandInsideARingAsOftenAsItsShareOfTheArea) {
    std::vector<Obstacle> const things{ring(300.0F, {500, 500})};
    Arena const arena = square(1000.0F);
    std::vector<float> const small(4000, 1.0F);
    double const clearance = 1.01 * 1.1;  // small against the ring's half thickness of 10 mm
    double const inside_mm2 = std::numbers::pi * std::pow(290.0 - clearance, 2);
    double const outside_mm2 =
        std::pow(1000.0 - 2.0 * clearance, 2) - std::numbers::pi * std::pow(310.0 + clearance, 2);
    double const expected = inside_mm2 / (inside_mm2 + outside_mm2);
    auto const placements = place_seeded(named("random"), small, {arena, things});
    auto const inside = std::ranges::count_if(placements, [](auto& p) {
        return length(p.position_mm - Vec2{500, 500}) < 300.0F;
    });
    EXPECT_NEAR(static_cast<double>(inside) / 4000.0, expected, 4.0 * std::sqrt(expected * (1.0 - expected) / 4000.0));
}

TEST(FormationAmongObstacles, LloydIsMoreEvenThanChance) {
    std::vector<Obstacle> const things = furniture();
    std::vector<float> const radii(100, kRobotRadius);
    auto const closest_mm = [&](char const* name) {
        auto const placements = place_seeded(named(name), radii, {kHall, things});
        double sum = 0.0;
        for (auto const& own : placements) {
            float nearest = std::numeric_limits<float>::infinity();
            for (auto const& other : placements) {
                float const distance = length(own.position_mm - other.position_mm);
                nearest = distance > 0.0F ? std::min(nearest, distance) : nearest;
            }
            sum += nearest;
        }
        return sum / 100.0;
    };
    // 3.3 m2 for 100: a hexagonal grid has 195 mm between neighbours; points have 1 / (2 sqrt(density)), 91 mm, by
    // chance, and robots, which keep off each other, a little more.
    EXPECT_GT(closest_mm("lloyd"), 130.0);
    EXPECT_GT(closest_mm("power_lloyd"), 130.0);
    EXPECT_LT(closest_mm("random"), 125.0);
}

TEST(ObstacleImages, AreWhereWhatLeavesAPeriodicBoxComesInAgain) {
    Box const box{{0, 0}, {1000, 500}};
    EXPECT_TRUE(images_across(box, solid(kDisk, {500, 250})).empty());
    EXPECT_TRUE(images_across(box, solid(kDisk, {100, 100})).empty());  // just touches the borders
    auto const right = images_across(box, solid(kDisk, {950, 250}));
    ASSERT_EQ(right.size(), 1U);
    EXPECT_EQ(right[0].line, (Polygon{{-50, 250}}));
    EXPECT_EQ(right[0].half_thickness_mm, 100.0F);
    EXPECT_EQ(right[0].name, "'thing'");
    EXPECT_EQ(images_across(box, solid(kBox, {20, 490})).size(), 3U);  // in a corner
    auto const beam =
        images_across(box, solid({.kind = ShapeKind::rectangle, .width_mm = 20, .height_mm = 480}, {995, 250}));
    ASSERT_EQ(beam.size(), 1U);
    EXPECT_NEAR(gap_mm(beam[0], {10, 250}), 5.0F, kTolerance);
}

}  // namespace
}  // namespace pogosim
