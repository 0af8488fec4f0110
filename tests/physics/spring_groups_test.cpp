// Springs of membranes in groups of four: each spring once, and no dot twice in a group.
#include "physics/spring_groups.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <tuple>

#include "support/small_world.hpp"

namespace pogosim {
namespace {

/// The number of the dot in a row and lane; kNone: none.
std::uint32_t dot_in(SpringGroups const& springs, std::uint32_t row, std::uint32_t lane) {
    for (std::uint32_t dot = 0; dot < springs.dot_count(); ++dot) {
        if (springs.row_of(dot) == row && springs.lane_of(dot) == lane) {
            return dot;
        }
    }
    return kNone;
}

/// The springs of the last of two rings.
SpringGroups springs_of(World const& world) {
    auto const first = static_cast<std::uint32_t>(world.joints.size() / 2);
    return {world, world.membranes.back(), first, first};
}

World two_rings(std::uint32_t dots) {
    World world = testing::square_world();
    testing::add_ring(world, {.dots = dots});
    testing::add_ring(world, {.dots = dots});
    return world;
}

TEST(SpringGroups, HaveEachSpringOnceAndNoDotTwice) {
    for (std::uint32_t dots = 4; dots < 90; ++dots) {
        World const world = two_rings(dots);
        SpringGroups const springs = springs_of(world);
        std::multiset<std::uint32_t> joints;
        for (SpringGroup const& group : springs.groups()) {
            std::multiset<std::uint32_t> joined;
            for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
                if (group.joint[lane] == kNone) {
                    EXPECT_EQ(group.length_mm[lane], 0.0F);
                    continue;
                }
                Joint const& joint = world.joints[group.joint[lane]];
                joints.insert(group.joint[lane]);
                EXPECT_EQ(group.length_mm[lane], joint.length_mm);
                for (auto const& [body, row, in_lane] :
                     {std::tuple(joint.a, group.row_a, lane), {joint.b, group.row_b, (lane + group.shift) % kLanes}}) {
                    std::uint32_t const dot = dot_in(springs, row, in_lane);
                    EXPECT_EQ(dot, body - world.membranes.back().body);
                    joined.insert(dot);
                }
            }
            EXPECT_EQ(std::set(joined.begin(), joined.end()).size(), joined.size()) << dots << " dots";
        }
        EXPECT_EQ(joints.size(), 2 * dots);
        EXPECT_EQ(std::set(joints.begin(), joints.end()).size(), 2 * dots);
    }
}

TEST(SpringGroups, AreFullButForTheEndsOfArcs) {
    EXPECT_EQ(springs_of(two_rings(80)).groups().size(), 40);
    EXPECT_LE(springs_of(two_rings(77)).groups().size(), 44);
}

TEST(SpringGroups, LeaveHingesOut) {
    World world = testing::square_world();
    testing::add_ring(world, {.dots = 40, .segments = true});
    SpringGroups const springs(world, world.membranes[0], 0, static_cast<std::uint32_t>(world.joints.size()));
    EXPECT_EQ(springs.groups().size(), 10);
    EXPECT_TRUE(std::ranges::all_of(springs.groups(), [](SpringGroup const& group) {
        return std::ranges::none_of(group.joint, [](std::uint32_t joint) { return joint % 2 == 0; });
    }));
}

}  // namespace
}  // namespace pogosim
