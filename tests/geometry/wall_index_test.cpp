#include "geometry/wall_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "base/random.hpp"

namespace pogosim {
namespace {

Arena bundled_arena(std::string const& name) {
    return scale_arena(read_arena_file(std::string(POGOSIM_SOURCE_DIR) + "/arenas/" + name + ".csv"), {});
}

Vec2 random_place(Arena const& arena, RandomStream& random) {
    Vec2 const size = arena.bounds.size();
    return {random.uniform(-0.2F * size.x, 1.2F * size.x), random.uniform(-0.2F * size.y, 1.2F * size.y)};
}

/// The arena with the corners of all polygons in the opposite order.
Arena walked_the_other_way(Arena const& arena) {
    std::vector<Polygon> polygons = arena.polygons;
    for (Polygon& polygon : polygons) {
        std::ranges::reverse(polygon);
    }
    return make_arena(polygons);
}

TEST(WallIndex, EachEdgeBeginsWhereThePreviousOneEndsAndHasFreeSpaceOnItsRight) {
    for (char const* const name : {"square", "disk", "annulusBarred", "arena8", "star8", "H"}) {
        Arena const arena = bundled_arena(name);
        for (Arena const& walked : {arena, walked_the_other_way(arena)}) {
            WallIndex const walls(walked);
            for (std::uint32_t number = 0; number < walls.edges().size(); ++number) {
                WallEdge const& edge = walls.edges()[number];
                EXPECT_EQ(edge.number, number);
                EXPECT_EQ(walls.edges()[edge.previous].to, edge.from) << name << ", edge " << number;
                Vec2 const way = edge.to - edge.from;
                Vec2 const right = (1.0F / length(way)) * Vec2{-way.y, way.x};  // y points down
                Vec2 const middle = 0.5F * (edge.from + edge.to);
                EXPECT_TRUE(walked.contains(middle + 0.1F * right)) << name << ", edge " << number;
                EXPECT_FALSE(walked.contains(middle - 0.1F * right)) << name << ", edge " << number;
            }
        }
    }
}

TEST(WallIndex, KnowsTheDistanceToTheNearestWall) {
    RandomStream random(1, 0);
    for (char const* const name : {"square", "disk", "annulusBarred", "arena8", "star8", "H"}) {
        Arena const arena = bundled_arena(name);
        WallIndex const walls(arena);
        for (int i = 0; i < 500; ++i) {
            Vec2 const place = random_place(arena, random);
            float const most_mm = random.uniform(0.0F, 500.0F);
            ASSERT_NEAR(walls.distance(place, most_mm), std::min(arena.distance_to_walls(place), most_mm), 0.01F)
                << name;
        }
    }
}

TEST(WallIndex, FindsWhereAMovingDiskTouchesFirst) {
    constexpr int kSamples = 2000;
    RandomStream random(2, 0);
    for (char const* const name : {"square", "disk", "annulusBarred", "arena8", "star8", "H"}) {
        Arena const arena = bundled_arena(name);
        WallIndex const walls(arena);
        for (int i = 0; i < 50; ++i) {
            Vec2 const from = random_place(arena, random);
            Vec2 const motion = random_place(arena, random) - from;
            float const radius_mm = random.uniform(0.0F, 1.0F) * arena.distance_to_walls(from);
            int sample = 0;
            while (sample < kSamples &&
                   arena.distance_to_walls(from + (static_cast<float>(sample + 1) / kSamples) * motion) > radius_mm) {
                ++sample;
            }
            auto const touch = walls.first_touch(from, motion, radius_mm);
            // A graze between two samples may be missed by them.
            if (sample == kSamples) {
                EXPECT_TRUE(!touch || arena.distance_to_walls(from + static_cast<float>(touch->fraction) * motion) >
                                          radius_mm - 0.1F);
                continue;
            }
            ASSERT_TRUE(touch) << name;
            Vec2 const centre = from + static_cast<float>(touch->fraction) * motion;
            EXPECT_LE(touch->fraction, static_cast<double>(sample + 1) / kSamples + 1e-6) << name;
            EXPECT_NEAR(arena.distance_to_walls(centre), radius_mm, 0.1F) << name;
            EXPECT_NEAR(length(touch->normal), 1.0F, 1e-4F);
            EXPECT_LE(dot(touch->normal, motion), 1e-3F * length(motion));
        }
    }
}

TEST(WallIndex, DiskThatAlreadyTouchesMayLeaveAndGoAlongButNoDeeper) {
    WallIndex const walls(make_arena({{{0, 0}, {1000, 0}, {1000, 1000}, {0, 1000}}}));
    Vec2 const place{500, 5};
    EXPECT_FALSE(walls.first_touch(place, {100, 0}, 10.0F));
    EXPECT_FALSE(walls.first_touch(place, {100, 1}, 10.0F));
    auto const touch = walls.first_touch(place, {100, -1}, 10.0F);
    ASSERT_TRUE(touch);
    EXPECT_EQ(touch->fraction, 0.0);
    EXPECT_EQ(touch->normal, (Vec2{0, 1}));
    // On the wall itself, inwards is free.
    EXPECT_FALSE(walls.first_touch({500, 0}, {0, 1}, 10.0F));
    EXPECT_TRUE(walls.first_touch({500, 0}, {0, -1}, 10.0F));
}

TEST(WallIndex, FindsWallsThatADiskTouchesToTheLastBit) {
    // Oblique walls at whole millimetres, and disks of whole millimetres that touch them, give or take a rounding.
    struct Triple {
        float a;
        float b;
        float c;
    };
    std::array const triples{Triple{3, 4, 5}, Triple{5, 12, 13}, Triple{8, 15, 17}, Triple{20, 21, 29}};
    RandomStream random(4, 0);
    for (int i = 0; i < 20000; ++i) {
        Triple const& triple = triples[static_cast<std::size_t>(i) % triples.size()];
        Vec2 const along{triple.b, triple.a};
        Vec2 const across{-triple.a, triple.b};
        Vec2 const start{std::round(random.uniform(0.0F, 2000.0F)), std::round(random.uniform(0.0F, 2000.0F))};
        float const length = std::round(random.uniform(50.0F, 80.0F));
        Polygon const square{start, start + length * along, start + length * along + length * across,
                             start + length * across};
        float const radii = std::round(random.uniform(1.0F, 10.0F));
        Vec2 const from = start + std::round(random.uniform(10.0F, 40.0F)) * along + radii * across;
        EXPECT_TRUE(WallIndex(make_arena({square})).first_touch(from, -20.0F * across, radii * triple.c))
            << from.x << ", " << from.y;
    }
}

TEST(WallIndex, FindsWallsThatRunAlongTheBordersOfItsCellsWhereNumbersAreCoarse) {
    // A float has steps of 1/16 mm here. Eight cells along each side; a wall sinks by 1/2 mm from one row to the next.
    constexpr float kUlp = 0.0625F;
    RandomStream random(5, 0);
    for (int i = 0; i < 2000; ++i) {
        Vec2 const corner{std::round(random.uniform(6e5F, 1e6F)), std::round(random.uniform(6e5F, 1e6F))};
        float const side = std::round(random.uniform(2300.0F, 2900.0F) / kUlp) * kUlp;
        auto const row = static_cast<float>(1 + i % 7);
        Vec2 const from = corner + Vec2{100, std::round((row * side / 8.0F - 0.25F) / kUlp) * kUlp};
        Polygon const box{corner, corner + Vec2{side, 0}, corner + Vec2{side, side}, corner + Vec2{0, side}};
        WallIndex const walls(make_arena({box, {from, from + Vec2{2048, 0.5F}, from + Vec2{1024, 30}}}));
        for (int k = 0; k <= 8; ++k) {
            Vec2 const on_the_wall = from + static_cast<float>(k) * Vec2{256, kUlp};
            EXPECT_LT(walls.distance(on_the_wall, 0.01F), 0.01F) << on_the_wall.x << ", " << on_the_wall.y;
        }
    }
}

}  // namespace
}  // namespace pogosim
