#include "geometry/arena.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>
#include <string>

#include "base/error.hpp"

namespace pogosim {
namespace {

ArenaOutline shipped(std::string const& name) {
    return read_arena_file(std::filesystem::path(POGOSIM_SOURCE_DIR) / "arenas" / (name + ".csv"));
}

ArenaOutline const kRectangle{{{{-3, 5}, {1, 5}, {1, 7}, {-3, 7}}}, "rectangle.csv"};
ArenaOutline const kFrame{{{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{1, 1}, {1, 3}, {3, 3}, {3, 1}}}, "frame.csv"};

TEST(Arena, ScalingGivesTheAreaAskedForAndKeepsTheAspectRatio) {
    Arena const arena = scale_arena(kRectangle, {2.0e6, false});
    EXPECT_NEAR(arena.area_mm2, 2.0e6, 1.0);
    EXPECT_EQ(arena.bounds.min, (Vec2{0, 0}));
    EXPECT_FLOAT_EQ(arena.bounds.max.x, 2000.0F);
    EXPECT_FLOAT_EQ(arena.bounds.max.y, 1000.0F);
}

TEST(Arena, WithoutAnAreaTheOutlineIsInMillimetres) {
    Arena const arena = scale_arena(kRectangle, {});
    EXPECT_EQ(arena.area_mm2, 8.0);
    EXPECT_EQ(arena.bounds.min, (Vec2{0, 0}));
    EXPECT_EQ(arena.bounds.max, (Vec2{4, 2}));
}

TEST(Arena, StretchingMakesTheBoundingBoxASquareOfTheSameNetArea) {
    Arena const arena = scale_arena(kRectangle, {2.25e6, true});
    EXPECT_NEAR(arena.area_mm2, 2.25e6, 1.0);
    EXPECT_FLOAT_EQ(arena.bounds.max.x, 1500.0F);
    EXPECT_FLOAT_EQ(arena.bounds.max.y, 1500.0F);
}

TEST(Arena, AreaIsTheOuterPolygonLessItsHoles) {
    Arena const arena = scale_arena(kFrame, {1.2e6, false});
    EXPECT_NEAR(arena.area_mm2, 1.2e6, 1.0);
    EXPECT_FLOAT_EQ(arena.bounds.max.x, 1264.9110F);  // 4 sqrt(1e5)
}

TEST(Arena, PointInAHoleIsOutside) {
    Arena const arena = make_arena(kFrame.polygons);
    EXPECT_TRUE(arena.contains({0.5F, 0.5F}));
    EXPECT_TRUE(arena.contains({3.5F, 2.0F}));
    EXPECT_FALSE(arena.contains({2.0F, 2.0F}));
    EXPECT_FALSE(arena.contains({5.0F, 2.0F}));
    EXPECT_FALSE(arena.contains({-1.0F, -1.0F}));
}

TEST(Arena, NearestWallMayBeAHole) {
    Arena const arena = make_arena(kFrame.polygons);
    EXPECT_FLOAT_EQ(arena.distance_to_walls({0.25F, 2.0F}), 0.25F);
    EXPECT_FLOAT_EQ(arena.distance_to_walls({0.75F, 2.0F}), 0.25F);
    EXPECT_FLOAT_EQ(arena.distance_to_walls({2.0F, 2.0F}), 1.0F);
}

TEST(Arena, PolygonsInMillimetresStayWhereTheyAre) {
    Arena const arena = make_arena(kRectangle.polygons);
    EXPECT_EQ(arena.bounds.min, (Vec2{-3, 5}));
    EXPECT_EQ(arena.outer(), kRectangle.polygons[0]);
    EXPECT_DOUBLE_EQ(arena.area_mm2, 8.0);
}

TEST(Arena, HolesLargerThanTheOuterPolygonAreRefused) {
    ArenaOutline const inside_out{{kFrame.polygons[1], kFrame.polygons[0]}, "inside_out.csv"};
    try {
        scale_arena(inside_out, {1.0e6, false});
        FAIL() << "accepted";
    } catch (ConfigError const& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with("inside_out.csv: ")) << error.what();
    }
}

TEST(Arena, FarFromItsOriginAnOutlineKeepsItsShape) {
    ArenaOutline far = kFrame;
    for (Polygon& polygon : far.polygons) {
        for (Vec2& corner : polygon) {
            corner = corner + Vec2{1000000.0F, -2000000.0F};
        }
    }
    Arena const near_arena = scale_arena(kFrame, {1.0e6, false});
    Arena const far_arena = scale_arena(far, {1.0e6, false});
    EXPECT_EQ(near_arena.polygons, far_arena.polygons);
}

TEST(Arena, DiskKeepsItsAreaWithinOnePerMille) {
    Arena const arena = scale_arena(shipped("disk"), {1.0e6, false});
    float const radius_mm = 0.5F * arena.bounds.size().x;
    EXPECT_NEAR(std::numbers::pi * radius_mm * radius_mm, 1.0e6, 1.0e3);
    EXPECT_NEAR(arena.distance_to_walls(arena.bounds.centre()), radius_mm, 1.0e-3 * radius_mm);
}

TEST(Arena, SizesAtOneSquareMetreAreThoseThatConfigurationsAreWrittenFor) {
    struct Expected {
        char const* name;
        double width_mm;
        double height_mm;
    };
    // Reference values of the arenas that existing configurations use, within 1 %.
    for (Expected const& expected : {Expected{"disk", 1128.7, 1128.6}, Expected{"annulus", 1499.4, 1496.6},
                                     Expected{"star", 1707.0, 1795.0}, Expected{"line", 450.8, 2218.7},
                                     Expected{"squarewithHole", 1154.7, 1154.7}, Expected{"square", 1000.0, 1000.0}}) {
        Vec2 const size = scale_arena(shipped(expected.name), {1.0e6, false}).bounds.size();
        EXPECT_NEAR(size.x, expected.width_mm, 0.01 * expected.width_mm) << expected.name;
        EXPECT_NEAR(size.y, expected.height_mm, 0.01 * expected.height_mm) << expected.name;
    }
}

}  // namespace
}  // namespace pogosim
