// Islands of bodies that touch, against a search through all pairs.
#include "physics/islands.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <vector>

#include "base/random.hpp"
#include "physics/near_contacts.hpp"
#include "physics/neighbour_list.hpp"
#include "physics/wall_neighbour_list.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

constexpr float kSideMm = 1000.0F;
constexpr float kReachMm = 3.0F;

using Group = std::set<std::uint32_t>;

/// All that is needed to find islands in a world.
struct Finder {
    explicit Finder(World const& world)
        : places(world),
          pairs(world),
          wall_neighbour_list(world, places.walls()),
          contacts(world, {}, wall_neighbour_list.sides()),
          assemblies(world) {
        build(world);
    }

    void build(World const& world) {
        pairs.build(world, kReachMm, workers);
        wall_neighbour_list.build(world, places, pairs.skin_mm());
        contacts.build(world, assemblies, pairs, wall_neighbour_list);
    }

    void find(World const& world) { islands.find(world, assemblies, contacts, {.reach_mm = kReachMm}, workers); }

    Group bodies_of(Island const& island) const {
        Group bodies;
        for (std::uint32_t link = island.first; link != kNone; link = islands.contacts()[link].next) {
            std::uint32_t const contact = islands.contacts()[link].contact;
            bodies.insert(contacts.near()[contact].a);
            if (contact < contacts.pair_count()) {
                bodies.insert(contacts.near()[contact].b);
            }
        }
        return bodies;
    }

    WorkerPool workers;
    PositionCorrection places;
    NeighbourList pairs;
    WallNeighbourList wall_neighbour_list;
    NearContacts contacts;
    Assemblies assemblies;
    Islands islands;
};

float gap_mm(World const& world, std::uint32_t a, std::uint32_t b) {
    Bodies const& bodies = world.bodies;
    return length(minimum_image(world, bodies.position_mm[a], bodies.position_mm[b])) - bodies.radius_mm[a] -
           bodies.radius_mm[b];
}

/// Moving bodies that are in reach of each other, directly or through other moving ones, or of something fixed.
std::set<Group> all_groups(World const& world) {
    Bodies const& bodies = world.bodies;
    auto const count = static_cast<std::uint32_t>(bodies.size());
    std::set<Group> groups;
    for (std::uint32_t start = 0; start < count; ++start) {
        if (bodies.spec[start].fixed) {
            continue;
        }
        Group group{start};
        bool touches_fixed = !world.periodic && world.arena.distance_to_walls(bodies.position_mm[start]) <
                                                    bodies.radius_mm[start] + kReachMm;
        std::vector<std::uint32_t> ahead{start};
        while (!ahead.empty()) {
            std::uint32_t const a = ahead.back();
            ahead.pop_back();
            for (std::uint32_t b = 0; b < count; ++b) {
                bool const touches = b != a && gap_mm(world, a, b) < kReachMm;
                touches_fixed = touches_fixed || (touches && bodies.spec[b].fixed);
                if (touches && !bodies.spec[b].fixed && group.insert(b).second) {
                    ahead.push_back(b);
                }
            }
        }
        if (group.size() > 1 || touches_fixed) {
            groups.insert(group);
        }
    }
    return groups;
}

World random_world(RandomStream& random, bool periodic) {
    World world = testing::square_world(kSideMm);
    world.periodic = periodic;
    auto const count = 20 + random.below(150);
    for (std::uint32_t i = 0; i < count; ++i) {
        ObjectSpec spec = testing::pogobot_spec();
        spec.shape.radius_mm = random.uniform(10.0F, 30.0F);
        spec.body->fixed = random.below(8) == 0;
        testing::add_robot(world, {random.uniform(31.0F, kSideMm - 31.0F), random.uniform(31.0F, kSideMm - 31.0F)},
                           0.0F, spec);
    }
    return world;
}

TEST(Islands, AreThoseThatASearchThroughAllPairsFinds) {
    RandomStream random(1, 0);
    for (int round = 0; round < 60; ++round) {
        World const world = random_world(random, round % 2 == 0);
        Finder finder(world);
        finder.find(world);
        std::set<Group> found;
        for (Island const& island : finder.islands.islands()) {
            Group const bodies = finder.bodies_of(island);
            EXPECT_TRUE(found.insert(bodies).second) << "twice the same island";
            for (std::uint32_t const body : bodies) {
                EXPECT_EQ(finder.islands.has_contact(body), island.is_active);
            }
        }
        EXPECT_EQ(found, all_groups(world));
    }
}

/// Three disks in a row with these gaps, mm, and speeds to the right, mm/s.
World row_of_three(float first_gap_mm, float second_gap_mm, std::vector<float> const& speeds_mm_s) {
    World world = testing::square_world(kSideMm);
    float x = 300.0F;
    for (float const step_mm : {0.0F, 53.0F + first_gap_mm, 53.0F + second_gap_mm}) {
        x += step_mm;
        testing::add_robot(world, {x, 500.0F});
    }
    for (std::size_t i = 0; i < 3; ++i) {
        world.bodies.velocity_mm_s[i] = {speeds_mm_s[i], 0.0F};
    }
    return world;
}

TEST(Islands, AreActiveWhenTwoMeetWithinTheStep) {
    struct Case {
        float first_gap_mm;
        float second_gap_mm;
        std::vector<float> speeds_mm_s;
        bool is_active;
    };
    // A step is 10 ms.
    for (auto const& [first_gap_mm, second_gap_mm, speeds_mm_s, is_active] : {
             Case{1.0F, 1.0F, {0.0F, 0.0F, 0.0F}, false},     // all rest
             Case{1.0F, 1.0F, {50.0F, 50.0F, 50.0F}, false},  // all go together
             Case{1.0F, 1.0F, {80.0F, 0.0F, 0.0F}, false},    // 0.8 mm nearer
             Case{1.0F, 1.0F, {120.0F, 0.0F, 0.0F}, true},    // 1.2 mm nearer
             Case{1.0F, 1.0F, {0.0F, 0.0F, -120.0F}, true},   // from the other side
             Case{1.0F, 1.0F, {0.0F, 0.0F, 500.0F}, false},   // away
             Case{1.0F, -0.1F, {0.0F, 0.0F, 0.0F}, true},     // they overlap
             Case{1.0F, -0.1F, {0.0F, 0.0F, 500.0F}, true},   // and part
             Case{1.0F, -0.04F, {0.0F, 0.0F, 0.0F}, false},   // within the tolerance
         }) {
        World const world = row_of_three(first_gap_mm, second_gap_mm, speeds_mm_s);
        Finder finder(world);
        finder.find(world);
        ASSERT_EQ(finder.islands.islands().size(), 1U);
        EXPECT_EQ(finder.islands.islands()[0].is_active, is_active) << first_gap_mm << " " << second_gap_mm;
        EXPECT_EQ(finder.bodies_of(finder.islands.islands()[0]), (Group{0, 1, 2}));
    }
}

TEST(Islands, HoldTogetherWhatASoftMembraneJoins) {
    World world = testing::square_world(kSideMm);
    testing::add_robot(world, {500.0F - 242.0F, 500.0F});  // 5.5 mm from its dots
    testing::add_robot(world, {500.0F + 238.0F, 500.0F});  // 1.5 mm
    testing::add_robot(world, {500.0F, 500.0F + 238.0F});  // the same, on another side
    Membrane const membrane = testing::add_ring(world, {});
    Finder at_rest(world);
    at_rest.find(world);
    ASSERT_EQ(at_rest.islands.islands().size(), 1U);
    Island const& island = at_rest.islands.islands()[0];
    EXPECT_FALSE(island.is_active);
    EXPECT_EQ(island.first_assembly, 0U);
    EXPECT_TRUE(at_rest.bodies_of(island).contains(1));
    EXPECT_TRUE(at_rest.bodies_of(island).contains(2));
    EXPECT_FALSE(at_rest.bodies_of(island).contains(0));

    world.bodies.velocity_mm_s[membrane.body + 7] = {0.0F, 1.0F};
    at_rest.find(world);
    EXPECT_TRUE(at_rest.islands.islands()[0].is_active);
    EXPECT_TRUE(at_rest.islands.has_contact(membrane.body + 50));
}

TEST(Islands, HaveAMembraneThatFliesAlone) {
    World world = testing::square_world(kSideMm);
    Membrane const membrane = testing::add_ring(world, {});
    Finder finder(world);
    finder.find(world);
    EXPECT_TRUE(finder.islands.islands().empty());
    world.bodies.velocity_mm_s.assign(world.bodies.size(), {10.0F, 0.0F});
    finder.find(world);
    ASSERT_EQ(finder.islands.islands().size(), 1U);
    EXPECT_TRUE(finder.islands.islands()[0].is_active);
    EXPECT_EQ(finder.islands.islands()[0].contact_count, 0U);
    EXPECT_TRUE(finder.islands.has_contact(membrane.body + 3));
}

TEST(NearContacts, KeepTheirImpulsesWhenTheyAreListedAnew) {
    World world = row_of_three(1.0F, 1.0F, {0.0F, 0.0F, 0.0F});
    testing::add_robot(world, {27.0F, 500.0F});   // at the wall on the left
    testing::add_robot(world, {100.0F, 100.0F});  // alone
    Finder finder(world);
    NearContacts& contacts = finder.contacts;
    auto const impulse_of = [&](std::uint32_t a) {
        for (std::size_t i = 0; i < contacts.near().size(); ++i) {
            if (contacts.near()[i].a == a) {
                return contacts.driven_impulse()[i];
            }
        }
        return -1.0F;
    };
    ASSERT_EQ(contacts.near().size(), 3U);
    for (std::size_t i = 0; i < contacts.near().size(); ++i) {
        contacts.driven_impulse()[i] = 1.0F + static_cast<float>(contacts.near()[i].a);
    }
    // One contact ends, and a new one comes before the others.
    world.bodies.position_mm[2] = {155.0F, 100.0F};
    finder.build(world);
    ASSERT_EQ(contacts.near().size(), 3U);
    EXPECT_EQ(impulse_of(0), 1.0F);
    EXPECT_EQ(impulse_of(3), 4.0F);
    EXPECT_EQ(impulse_of(2), 0.0F);
    EXPECT_EQ(contacts.near()[0].a, 2U);
}

}  // namespace
}  // namespace pogosim
