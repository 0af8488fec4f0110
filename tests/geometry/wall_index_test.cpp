#include "geometry/wall_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

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

}  // namespace
}  // namespace pogosim
