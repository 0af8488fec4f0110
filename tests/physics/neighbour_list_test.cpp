// The list of near pairs against all pairs.
#include "physics/neighbour_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/random.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

World random_world(RandomStream& random, float side_mm, bool periodic) {
    World world = testing::square_world(side_mm);
    world.periodic = periodic;
    auto const count = 1 + random.below(300);
    for (std::uint32_t i = 0; i < count; ++i) {
        ObjectSpec spec = testing::pogobot_spec();
        // A few are much larger than the others.
        spec.shape.radius_mm = random.below(50) == 0 ? random.uniform(50.0F, 300.0F) : random.uniform(5.0F, 30.0F);
        spec.body->fixed = random.below(5) == 0;
        testing::add_robot(world, {random.uniform(0.0F, side_mm), random.uniform(0.0F, side_mm)}, 0.0F, spec);
    }
    return world;
}

/// Pairs of which one can move whose disks are less than `gap_mm` apart, by looking at all.
Pairs all_nearer_than(World const& world, float gap_mm) {
    Bodies const& bodies = world.bodies;
    Pairs pairs;
    for (std::uint32_t a = 0; a < bodies.size(); ++a) {
        for (std::uint32_t b = a + 1; b < bodies.size(); ++b) {
            float const far = length(minimum_image(world, bodies.position_mm[a], bodies.position_mm[b]));
            bool const can_move = !bodies.spec[a].fixed || !bodies.spec[b].fixed;
            if (can_move && far - bodies.radius_mm[a] - bodies.radius_mm[b] < gap_mm) {
                pairs.emplace_back(a, b);
            }
        }
    }
    return pairs;
}

Pairs listed(NeighbourList const& near) {
    Pairs pairs;
    for (NeighbourPair const& pair : near.pairs()) {
        pairs.emplace_back(std::min(pair.a, pair.b), std::max(pair.a, pair.b));
    }
    std::ranges::sort(pairs);
    return pairs;
}

class NeighbourListOf : public ::testing::TestWithParam<bool> {};

TEST_P(NeighbourListOf, AreAllThatAreNearEachOnce) {
    WorkerPool workers;
    RandomStream random(7, 0);
    for (int scene = 0; scene < 60; ++scene) {
        World const world = random_world(random, random.uniform(100.0F, 3000.0F), GetParam());
        NeighbourList near(world);
        near.build(world, random.uniform(0.1F, 20.0F), workers);
        Pairs const pairs = listed(near);
        EXPECT_TRUE(std::ranges::adjacent_find(pairs) == pairs.end());
        // Up to the rounding of a distance.
        Pairs const least = all_nearer_than(world, near.skin_mm() - 1e-3F);
        Pairs const most = all_nearer_than(world, near.skin_mm() + 1e-3F);
        EXPECT_TRUE(std::ranges::includes(pairs, least)) << scene;
        EXPECT_TRUE(std::ranges::includes(most, pairs)) << scene;
    }
}

TEST_P(NeighbourListOf, AreValidUntilABodyHasGoneHalfTheSkin) {
    WorkerPool workers;
    RandomStream random(8, 0);
    for (int scene = 0; scene < 30; ++scene) {
        World world = random_world(random, 1000.0F, GetParam());
        NeighbourList near(world);
        constexpr float reach_mm = 2.0F;
        EXPECT_FALSE(near.covers(world, reach_mm, workers));
        near.build(world, reach_mm, workers);
        int steps = 0;
        for (; near.covers(world, reach_mm, workers); ++steps) {
            Pairs const pairs = listed(near);
            EXPECT_TRUE(std::ranges::includes(pairs, all_nearer_than(world, reach_mm))) << scene;
            for (Vec2& place : world.bodies.position_mm) {
                place = wrapped(world, place + Vec2{random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F)});
            }
        }
        EXPECT_GT(steps, 0);
        EXPECT_LT(steps, 5000);
    }
}

INSTANTIATE_TEST_SUITE_P(World, NeighbourListOf, ::testing::Bool(),
                         [](::testing::TestParamInfo<bool> const& info) { return info.param ? "periodic" : "solid"; });

}  // namespace
}  // namespace pogosim
