#include "sim/link_finder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "base/random.hpp"
#include "comms/ir_channel.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_membrane;
using testing::add_robot;
using testing::add_wall;
using testing::square_world;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kRadius = 26.5F;
constexpr std::uint8_t kFront = 1;
constexpr std::uint8_t kRight = 2;
constexpr std::uint8_t kBack = 4;
constexpr std::uint8_t kLeft = 8;

std::vector<InfraredLink> links_of(World const& world, std::vector<float> range_mm) {
    return LinkFinder().find(world, range_mm);
}

void expect_near(Vec2 point, Vec2 expected) {
    EXPECT_NEAR(point.x, expected.x, 0.01F);
    EXPECT_NEAR(point.y, expected.y, 0.01F);
}

TEST(Links, TwoRobotsInReachHaveOneLinkForBothDirections) {
    World world = square_world();
    add_robot(world, {500, 500});
    add_robot(world, {600, 500});
    auto const links = links_of(world, {80, 80});
    ASSERT_EQ(links.size(), 1U);
    EXPECT_EQ(links[0].from, 0U);
    EXPECT_EQ(links[0].to, 1U);
    EXPECT_EQ(links[0].emitters, kFront);
    EXPECT_EQ(links[0].emitters_back, kBack);
    expect_near(links[0].from_mm, {500 + kRadius, 500});
    expect_near(links[0].to_mm, {600 - kRadius, 500});
}

TEST(Links, EndsOfALinkBetweenRectanglesAreOnTheirSides) {
    World world = square_world();
    add_robot(world, {500, 500});
    add_robot(world, {620, 500}, kPi / 2.0F);  // its longer side is across the link
    for (std::uint32_t const body : {0U, 1U}) {
        world.bodies.shape[body] = {.kind = ShapeKind::rectangle, .width_mm = 60.0F, .height_mm = 30.0F};
        world.bodies.radius_mm[body] = bounding_radius(world.bodies.shape[body]);
    }
    auto const links = links_of(world, {80, 80});
    ASSERT_EQ(links.size(), 1U);
    expect_near(links[0].from_mm, {530, 500});
    expect_near(links[0].to_mm, {605, 500});
}

TEST(Links, RobotOfShorterReachOnlyListens) {
    World world = square_world();
    add_robot(world, {600, 500});
    add_robot(world, {500, 500}, kPi / 2.0F);  // heading down the screen, so that robot 0 is on its left
    auto const links = links_of(world, {10, 80});
    ASSERT_EQ(links.size(), 1U);
    EXPECT_EQ(links[0].from, 1U);
    EXPECT_EQ(links[0].to, 0U);
    EXPECT_EQ(links[0].emitters, kLeft);
    EXPECT_EQ(links[0].emitters_back, 0);
    EXPECT_TRUE(links_of(world, {0, 0}).empty());
}

TEST(Links, RobotInFrontOfTwoEmittersIsReachedByBoth) {
    World world = square_world();
    add_robot(world, {500, 500});
    add_robot(world, {560, 560});
    auto const links = links_of(world, {80, 80});
    ASSERT_EQ(links.size(), 1U);
    EXPECT_EQ(links[0].emitters, kFront | kRight);
    EXPECT_EQ(links[0].emitters_back, kBack | kLeft);
}

TEST(Links, OcclusionCanBreakOneDirectionAlone) {
    // Robot 1 stands just in front of robot 0 and hides robot 2 from it; robot 2 sees the edges of the large robot 0.
    World world = square_world();
    add_robot(world, {400, 500});
    add_robot(world, {490, 500});
    add_robot(world, {640, 500});
    world.bodies.radius_mm[0] = 60.0F;
    auto const links = links_of(world, {200, 200, 200});
    ASSERT_EQ(links.size(), 3U);
    EXPECT_EQ(links[2].from, 2U);
    EXPECT_EQ(links[2].to, 0U);
    EXPECT_EQ(links[2].emitters, kBack);
    EXPECT_EQ(links[2].emitters_back, 0);
}

TEST(Links, LinkGoesAcrossTheSeamOfAPeriodicArena) {
    World world = square_world();
    add_robot(world, {-30, 500});  // 970 inside the arena
    add_robot(world, {60, 500});
    EXPECT_EQ(links_of(world, {80, 80}).size(), 1U);  // 90 mm apart anyway
    world.periodic = true;
    for (Vec2 const place : {Vec2{-30, 500}, Vec2{970, 500}, Vec2{1970, -500}}) {
        world.bodies.position_mm[0] = place;
        auto const links = links_of(world, {80, 80});
        ASSERT_EQ(links.size(), 1U);
        EXPECT_EQ(links[0].emitters, kFront);
        EXPECT_EQ(links[0].emitters_back, kBack);
        expect_near(links[0].from_mm, {970 + kRadius, 500});
        expect_near(links[0].to_mm, {1060 - kRadius, 500});
    }
}

TEST(Links, LinkBetweenRobotsThatOverlapIsAPointBetweenThem) {
    World world = square_world();
    add_robot(world, {500, 500});
    add_robot(world, {550, 500});
    auto const links = links_of(world, {80, 80});
    ASSERT_EQ(links.size(), 1U);
    EXPECT_GE(links[0].to_mm.x, 500.0F);
    EXPECT_LE(links[0].from_mm.x, 550.0F);
    world.bodies.position_mm[1] = {500, 500};
    for (InfraredLink const& link : links_of(world, {80, 80})) {
        expect_near(link.from_mm, {500, 500});
        expect_near(link.to_mm, {500, 500});
    }
}

TEST(Links, WallIsReachedAtItsNearestPoint) {
    World world = square_world();
    add_robot(world, {950, 500});
    std::uint32_t const wall = add_wall(world, world.arena.polygons);
    auto const links = links_of(world, {80, 80});
    ASSERT_EQ(links.size(), 1U);
    EXPECT_EQ(links[0].from, 0U);
    EXPECT_EQ(links[0].to, wall);
    EXPECT_EQ(links[0].emitters, kFront | kRight | kBack | kLeft);  // 23.5, twice 50 and 76.5 mm away
    EXPECT_EQ(links[0].emitters_back, 1);
    expect_near(links[0].from_mm, {950 + kRadius, 500});
    expect_near(links[0].to_mm, {1000, 500});
    world.bodies.position_mm[0] = {910, 500};
    EXPECT_EQ(links_of(world, {80, 80})[0].emitters, kFront);
}

TEST(Links, WallThatARobotDoesNotReachCanBeHeard) {
    World world = square_world();
    add_robot(world, {950, 500});
    std::uint32_t const wall = add_wall(world, world.arena.polygons);
    auto const links = links_of(world, {0, 80});
    ASSERT_EQ(links.size(), 1U);
    EXPECT_EQ(links[0].from, wall);
    EXPECT_EQ(links[0].to, 0U);
    EXPECT_EQ(links[0].emitters, 1);
    EXPECT_EQ(links[0].emitters_back, 0);
    expect_near(links[0].from_mm, {1000, 500});
    expect_near(links[0].to_mm, {950 + kRadius, 500});
}

TEST(Links, MembraneIsReachedThroughTheSeam) {
    World world = square_world();
    world.periodic = true;
    add_robot(world, {945, 500});
    Polygon const box{{30, 400}, {130, 400}, {130, 600}, {30, 600}};
    std::uint32_t const membrane = add_membrane(world, box);
    auto const links = links_of(world, {80, 80});
    ASSERT_EQ(links.size(), 1U);
    EXPECT_EQ(links[0].to, membrane);
    EXPECT_EQ(links[0].emitters, kFront);
    expect_near(links[0].from_mm, {945 + kRadius, 500});
    expect_near(links[0].to_mm, {1030, 500});
}

/// Robots of several sizes, a wall and a membrane, all with their own reach.
World random_world(RandomStream& random, std::vector<float>& range_mm) {
    float const side_mm = 700.0F;
    World world = square_world(side_mm);
    world.periodic = random.below(2) == 1;
    world.ignore_occlusions = random.below(4) == 0;
    for (int i = 0; i < 25; ++i) {
        auto const robot =
            add_robot(world, {random.uniform(0.0F, side_mm), random.uniform(0.0F, side_mm)}, random.uniform(-kPi, kPi));
        world.bodies.radius_mm[robot] = random.uniform(10.0F, 40.0F);
    }
    add_wall(world, world.arena.polygons);
    Vec2 const corner{random.uniform(0.0F, side_mm), random.uniform(0.0F, side_mm)};
    add_membrane(world, {corner, corner + Vec2{100, 0}, corner + Vec2{100, 100}, corner + Vec2{0, 100}});
    for (std::size_t i = 0; i < world.robots.size(); ++i) {
        range_mm.push_back(random.below(8) == 0 ? 0.0F : random.uniform(0.0F, 80.0F));
    }
    for (Category& category : world.categories) {
        category.spec.robot->ir.reception = {.law = ReceptionLaw::constant, .rate = 1.0};
    }
    std::vector<int> const sizes(world.robots.size(), 20);
    world.mailboxes = Mailboxes(sizes, 382);
    return world;
}

TEST(Links, ChannelDeliversAlongThemAndNowhereElse) {
    RandomStream random(1, 0);
    int one_way = 0;
    int two_way = 0;
    for (int scene = 0; scene < 40; ++scene) {
        std::vector<float> range_mm;
        World world = random_world(random, range_mm);
        auto const count = static_cast<std::uint32_t>(world.robots.size());
        std::vector<std::vector<unsigned>> linked(count, std::vector<unsigned>(count, 0));
        for (InfraredLink const& link : links_of(world, range_mm)) {
            EXPECT_NE(link.emitters, 0);
            linked[link.from][link.to] = link.emitters;
            linked[link.to][link.from] = link.emitters_back;
            ++(link.emitters_back == 0 ? one_way : two_way);
        }
        IrChannel channel;
        for (std::uint32_t from = 0; from < count; ++from) {
            for (unsigned emitter = 0; emitter < kMostFaces; ++emitter) {
                Transmission transmission;
                transmission.robot = from;
                transmission.emitters = static_cast<std::uint8_t>(1U << emitter);
                transmission.range_mm = range_mm[from];
                world.air.transmissions.push_back(transmission);
                channel.deliver(world);
                for (std::uint32_t to = 0; to < count; ++to) {
                    EXPECT_EQ(!world.mailboxes.empty(to), (linked[from][to] >> emitter & 1U) != 0)
                        << "scene " << scene << ": emitter " << emitter << " of " << from << " to " << to;
                    world.mailboxes.clear(to);
                }
            }
        }
    }
    EXPECT_GT(one_way, 100);
    EXPECT_GT(two_way, 100);
}

TEST(Links, ArePlacedFromRimToRim) {
    RandomStream random(2, 0);
    for (int scene = 0; scene < 20; ++scene) {
        std::vector<float> range_mm;
        World const world = random_world(random, range_mm);
        for (InfraredLink const& link : links_of(world, range_mm)) {
            for (auto const& [robot, point] : {std::pair{link.from, link.from_mm}, std::pair{link.to, link.to_mm}}) {
                if (world.spec_of(robot).model.sends_along_outline) {
                    continue;
                }
                float const radius_mm = world.bodies.radius_mm[robot];
                Vec2 const from_centre = minimum_image(world, world.bodies.position_mm[robot], point);
                EXPECT_LE(length(from_centre), radius_mm + 0.01F);
            }
            float const reach_mm = std::max(range_mm[link.from], range_mm[link.to]);
            EXPECT_LE(length(link.to_mm - link.from_mm), reach_mm + 0.5F * 40.0F * std::numbers::sqrt2_v<float>);
        }
    }
}

}  // namespace
}  // namespace pogosim
