// Walls and bodies that infrared does not pass.
#include "comms/infrared_blockers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "base/random.hpp"
#include "comms/visibility.hpp"
#include "support/shapes.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_membrane;
using testing::add_robot;
using testing::add_wall;
using testing::disk;
using testing::rectangle;
using testing::square_world;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kRadius = 26.5F;
constexpr float kFar = 400.0F;  // a range that reaches everywhere in these scenes
constexpr float kMarginMm = 0.02F;
constexpr std::uint8_t kFront = 1;
constexpr std::uint8_t kRight = 2;
constexpr std::uint8_t kLeft = 8;

using Robots = std::vector<std::uint32_t>;

Robots reached(World const& world, std::uint32_t robot, std::uint8_t emitters, float range_mm = kFar) {
    Visibility visibility;
    visibility.update(world);
    Robots result;
    for (Receiver const& receiver : visibility.receivers(world, robot, emitters, range_mm)) {
        result.push_back(receiver.robot);
    }
    return result;
}

/// A passive object that blocks. Add it after all robots.
std::uint32_t add_blocker(World& world, Shape const& shape, Vec2 position_mm, float heading_rad = 0.0F) {
    ObjectSpec spec;
    spec.shape = shape;
    spec.body = BodySpec{.fixed = true, .blocks_infrared = true};
    return testing::add_body(world, position_mm, heading_rad, spec);
}

Polygon box(Vec2 low, Vec2 high) {
    return {low, {high.x, low.y}, high, {low.x, high.y}};
}

/// Whether the front emitter of a robot at (400, 500) reaches one at this place, past a pillar of 20 mm at (500, 500).
bool passes_pillar(Vec2 receiver_mm, bool ignore_occlusions) {
    World world = square_world();
    world.ignore_occlusions = ignore_occlusions;
    add_robot(world, {400, 500});
    add_robot(world, receiver_mm);
    add_blocker(world, disk(20.0F), {500, 500});
    return reached(world, 0, kFront) == Robots{1};
}

TEST(Blockers, PillarHidesTheRobotsWhoseLinePassesWithinItsRadius) {
    Vec2 const emitter{400.0F + kRadius, 500};
    float const edge_rad = std::asin(20.0F / (500.0F - emitter.x));
    for (bool const ignore : {false, true}) {
        for (float const side : {-1.0F, 1.0F}) {
            for (float const distance_mm : {100.0F, 200.0F, 350.0F}) {
                float const margin_rad = kMarginMm / distance_mm;
                EXPECT_FALSE(passes_pillar(emitter + distance_mm * direction(side * (edge_rad - margin_rad)), ignore));
                EXPECT_TRUE(passes_pillar(emitter + distance_mm * direction(side * (edge_rad + margin_rad)), ignore));
            }
        }
        EXPECT_FALSE(passes_pillar({650, 500}, ignore));
        EXPECT_TRUE(passes_pillar({470, 500}, ignore)) << "in front of the pillar";
    }
}

TEST(Blockers, BodyThatDoesNotBlockHidesNothing) {
    World world = square_world();
    add_robot(world, {400, 500});
    add_robot(world, {650, 500});
    std::uint32_t const pillar = add_blocker(world, disk(20.0F), {500, 500});
    EXPECT_TRUE(reached(world, 0, kFront).empty());
    world.bodies.spec[pillar].blocks_infrared = false;
    EXPECT_EQ(reached(world, 0, kFront), Robots{1});
}

TEST(Blockers, WallWithAGapIsPassedThroughTheGapAlone) {
    // Holes of the arena that leave 470 to 530 mm free at x from 500 to 510.
    for (int step = 0; step <= 200; ++step) {
        float const y = 400.0F + static_cast<float>(step);
        World world = square_world();
        world.arena.polygons.push_back(box({500, 300}, {510, 470}));
        world.arena.polygons.push_back(box({500, 530}, {510, 700}));
        world.walls_block_infrared = true;
        add_robot(world, {400, 500});
        add_robot(world, {600, y});
        // The line rises by |y - 500| on the way from the emitter to x = 600; it has to be within 30 mm until x = 510.
        float const share = (510.0F - 400.0F - kRadius) / (600.0F - 400.0F - kRadius);
        float const at_wall_mm = share * std::abs(y - 500.0F);
        EXPECT_EQ(reached(world, 0, kFront), at_wall_mm < 30.0F ? Robots{1} : Robots{}) << y;
        world.walls_block_infrared = false;
        EXPECT_EQ(reached(world, 0, kFront), Robots{1}) << y;
    }
}

TEST(Blockers, LineThroughTheCornersOfAWallDoesNotSlipThrough) {
    for (bool const first : {false, true}) {
        World world = square_world();
        world.arena.polygons.push_back({{500, 470}, {530, 500}, {500, 530}, {470, 500}});
        world.walls_block_infrared = true;
        add_robot(world, first ? Vec2{400, 500} : Vec2{600, 500});
        add_robot(world, first ? Vec2{600, 500} : Vec2{400, 500});
        EXPECT_TRUE(reached(world, 0, kAllFaces).empty());
    }
}

TEST(Blockers, EmitterThatIsPressedIntoABodyDoesNotSendThroughIt) {
    // Plates thinner than the depth to which the emitter has got into them.
    World world = square_world();
    add_robot(world, {400, 500});
    add_robot(world, {560, 500});
    add_blocker(world, rectangle(0.2F, 200.0F), {400.0F + kRadius - 0.3F, 500});
    EXPECT_TRUE(reached(world, 0, kFront).empty());
    EXPECT_TRUE(reached(world, 1, kLeft).empty());
    World pillar = square_world();
    add_robot(pillar, {400, 500});
    add_robot(pillar, {560, 500});
    add_blocker(pillar, disk(20.0F), {400.0F + kRadius + 19.8F, 500});
    EXPECT_TRUE(reached(pillar, 0, kAllFaces).empty());
}

TEST(Blockers, OtherEmittersLookPastABody) {
    World world = square_world();
    add_robot(world, {400, 500});
    add_robot(world, {500, 570});
    add_blocker(world, disk(10.0F), {460, 530});
    // On the line from the front emitter, and beside that from the right one.
    EXPECT_TRUE(reached(world, 0, kFront).empty());
    EXPECT_EQ(reached(world, 0, kRight), Robots{1});
    EXPECT_EQ(reached(world, 0, kAllFaces), Robots{1});
    Visibility visibility;
    visibility.update(world);
    auto const receivers = visibility.receivers(world, 0, kAllFaces, kFar);
    ASSERT_EQ(receivers.size(), 1U);
    EXPECT_EQ(receivers[0].emitters, kRight);
    EXPECT_NEAR(receivers[0].from_emitter_mm.x, 100.0F, 1e-3F);
    EXPECT_NEAR(receivers[0].from_emitter_mm.y, 70.0F - kRadius, 1e-3F);
}

TEST(Blockers, RobotsBehindABodyStillHideOthers) {
    // Robot 1 is hidden by the plate, and hides robot 2 as it does without it.
    World world = square_world();
    add_robot(world, {400, 500});
    add_robot(world, {500, 500});
    add_robot(world, {560, 500});
    EXPECT_EQ(reached(world, 0, kFront), Robots{1});
    add_blocker(world, rectangle(2.0F, 10.0F), {450, 500});
    EXPECT_TRUE(reached(world, 0, kFront).empty());
}

TEST(Blockers, ActAcrossTheSeamOfAPeriodicArena) {
    for (float const x : {30.0F, 1030.0F, -970.0F}) {
        World world = square_world();
        world.periodic = true;
        add_robot(world, {930, 500});
        add_robot(world, {100, 500});
        EXPECT_EQ(reached(world, 0, kFront), Robots{1});
        add_blocker(world, disk(5.0F), {x, 500});
        EXPECT_TRUE(reached(world, 0, kFront).empty()) << x;
    }
}

TEST(Blockers, BarAsLongAsAPeriodicArenaBlocksOnBothSides) {
    // Its middle is 450 mm away, and its end comes in across the seam.
    World world = square_world();
    world.periodic = true;
    add_robot(world, {900, 500});
    add_robot(world, {40, 500});
    add_blocker(world, rectangle(10.0F, 960.0F), {980, 970});
    EXPECT_TRUE(reached(world, 0, kFront).empty());
    World shorter = square_world();
    shorter.periodic = true;
    add_robot(shorter, {900, 500});
    add_robot(shorter, {40, 500});
    add_blocker(shorter, rectangle(10.0F, 930.0F), {980, 970});
    EXPECT_EQ(reached(shorter, 0, kFront), Robots{1});
}

TEST(Blockers, MovingBoxEntersALineAndLeavesIt) {
    World world = square_world();
    add_robot(world, {400, 500});
    add_robot(world, {600, 500});
    std::uint32_t const blocker = add_blocker(world, rectangle(40.0F, 20.0F), {500, 400});
    Visibility visibility;
    for (int step = 0; step < 400; ++step) {
        // Rests for a while at each place, so that receivers are cached.
        float const y = 400.25F + 0.5F * static_cast<float>(step - step % 4);
        set_pose(world.bodies, blocker, {500, y}, 0.0F);
        visibility.update(world);
        bool const is_between = std::abs(y - 500.0F) < 10.0F;
        EXPECT_EQ(visibility.receivers(world, 0, kFront, kFar).size(), is_between ? 0U : 1U) << y;
    }
}

TEST(Blockers, WallHearsAndIsHeardWhereNothingStandsBetween) {
    World world = square_world();
    add_robot(world, {950, 500});
    std::uint32_t const wall = add_wall(world, world.arena.polygons);
    world.walls_block_infrared = true;
    EXPECT_EQ(reached(world, 0, kFront, 80.0F), Robots{wall}) << "the wall does not hide itself";
    EXPECT_EQ(reached(world, wall, kFront, 80.0F), Robots{0});
    world.bodies.position_mm[0] = {1000.0F - kRadius + 0.05F, 500};  // pressed into it
    EXPECT_EQ(reached(world, 0, kFront, 80.0F), Robots{wall});
    EXPECT_EQ(reached(world, wall, kFront, 80.0F), Robots{0});
    world.bodies.position_mm[0] = {950, 500};
    add_blocker(world, rectangle(2.0F, 300.0F), {985, 500});
    EXPECT_TRUE(reached(world, 0, kAllFaces, 80.0F).empty());
    EXPECT_TRUE(reached(world, wall, kFront, 80.0F).empty());
}

TEST(Blockers, MembraneSeparatesInsideFromOutside) {
    World world = square_world();
    add_robot(world, {500, 500});  // inside
    add_robot(world, {560, 500});  // inside
    add_robot(world, {750, 500});  // outside
    Membrane const ring = testing::add_ring(world, {.centre_mm = {500, 500}, .radius_mm = 150.0F});
    world.ignore_occlusions = true;
    EXPECT_EQ(reached(world, 0, kAllFaces), (Robots{1, 2}));
    for (std::uint32_t k = 0; k < ring.body_count; ++k) {
        world.bodies.spec[ring.body + k].blocks_infrared = true;
    }
    EXPECT_EQ(reached(world, 0, kAllFaces), Robots{1});
    EXPECT_EQ(reached(world, 2, kAllFaces), Robots{});
    // It is itself heard on both sides.
    std::uint32_t const membrane =
        testing::add_outline(world, {.robot = 0, .polygons = {}, .body = ring.body, .body_count = ring.body_count}, 90);
    EXPECT_EQ(reached(world, membrane, kFront, 90.0F), (Robots{1, 2}));
    EXPECT_EQ(reached(world, 1, kAllFaces, 80.0F), (Robots{0, membrane}));
}

// Brute force, in double precision.

struct Vec2d {
    double x = 0.0;
    double y = 0.0;
};

Vec2d wide(Vec2 a) {
    return {static_cast<double>(a.x), static_cast<double>(a.y)};
}

double cross(Vec2d a, Vec2d b, Vec2d c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double distance_to_segment(Vec2d a, Vec2d b, Vec2d point) {
    double const length2 = std::pow(b.x - a.x, 2) + std::pow(b.y - a.y, 2);
    double const along = ((point.x - a.x) * (b.x - a.x) + (point.y - a.y) * (b.y - a.y)) / std::max(length2, 1e-12);
    double const t = std::clamp(along, 0.0, 1.0);
    return std::hypot(a.x + t * (b.x - a.x) - point.x, a.y + t * (b.y - a.y) - point.y);
}

double distance_of_segments(Vec2d a, Vec2d b, Vec2d c, Vec2d d) {
    bool const cross_each_other = cross(a, b, c) * cross(a, b, d) < 0.0 && cross(c, d, a) * cross(c, d, b) < 0.0;
    return cross_each_other ? 0.0
                            : std::min({distance_to_segment(a, b, c), distance_to_segment(a, b, d),
                                        distance_to_segment(c, d, a), distance_to_segment(c, d, b)});
}

enum class Sight { open, blocked, unclear };

/// Lines that nearly touch a blocker may go either way.
Sight sight_of(double distance_mm, double blocked_below_mm) {
    constexpr double unclear_mm = 0.02;
    if (distance_mm > blocked_below_mm + unclear_mm) {
        return Sight::open;
    }
    return distance_mm < blocked_below_mm - unclear_mm || (blocked_below_mm == 0.0 && distance_mm == 0.0)
               ? Sight::blocked
               : Sight::unclear;
}

Sight sight_past(Polygon const& corners, Vec2d from, Vec2d to, Vec2d shift) {
    double nearest = 1e9;
    double nearest_corner = 1e9;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        Vec2d const a{wide(corners[i]).x + shift.x, wide(corners[i]).y + shift.y};
        Vec2 const next = corners[(i + 1) % corners.size()];
        Vec2d const b{wide(next).x + shift.x, wide(next).y + shift.y};
        nearest = std::min(nearest, distance_of_segments(from, to, a, b));
        nearest_corner = std::min({nearest_corner, distance_to_segment(from, to, a), distance_to_segment(a, b, from),
                                   distance_to_segment(a, b, to)});
    }
    return nearest_corner < 0.02 ? Sight::unclear : sight_of(nearest, 0.0);
}

/// The worse of two, blocked before unclear.
Sight worse(Sight a, Sight b) {
    if (a == Sight::open || b == Sight::blocked) {
        return b;
    }
    return a;
}

Sight sight_past_body(World const& world, std::uint32_t body, Vec2 from, Vec2 to, Vec2d shift) {
    Shape const& shape = world.bodies.shape[body];
    Vec2 const centre = world.bodies.position_mm[body];
    Vec2d const middle{wide(centre).x + shift.x, wide(centre).y + shift.y};
    double const distance_mm = distance_to_segment(wide(from), wide(to), middle);
    if (shape.kind == ShapeKind::disk || distance_mm > static_cast<double>(bounding_radius(shape)) + 1.0) {
        return sight_of(distance_mm, static_cast<double>(bounding_radius(shape)));
    }
    return sight_past(moved(outline(shape), centre, world.bodies.heading_rad[body]), wide(from), wide(to), shift);
}

/// Whether a line that starts in the arena is blocked, by all images of all bodies.
Sight sight_along(World const& world, Vec2 from, Vec2 to) {
    Sight sight = Sight::open;
    int const images = world.periodic ? 2 : 0;
    Vec2d const size = wide(world.arena.bounds.size());
    for (std::uint32_t body = 0; body < world.bodies.size(); ++body) {
        for (int across = -images; world.bodies.spec[body].blocks_infrared && across <= images; ++across) {
            for (int down = -images; down <= images; ++down) {
                sight = worse(sight, sight_past_body(world, body, from, to, {size.x * across, size.y * down}));
            }
        }
    }
    if (world.walls_block_infrared && !world.periodic) {
        for (Polygon const& polygon : world.arena.polygons) {
            sight = worse(sight, sight_past(polygon, wide(from), wide(to), {}));
        }
    }
    return sight;
}

Shape random_shape(RandomStream& random) {
    float const size_mm = random.below(10) == 0 ? random.uniform(100.0F, 500.0F) : random.uniform(4.0F, 40.0F);
    switch (random.below(3)) {
        case 0:
            return disk(0.5F * size_mm);
        case 1:
            return rectangle(size_mm, random.uniform(2.0F, 30.0F));
        default:
            return {.kind = ShapeKind::triangle, .side_length_mm = size_mm};
    }
}

World random_world(RandomStream& random) {
    World world = square_world();
    world.arena.bounds.max.y = world.arena.polygons[0][2].y = world.arena.polygons[0][3].y = 700.0F;
    world.periodic = random.below(2) == 1;
    world.ignore_occlusions = random.below(2) == 1;
    world.walls_block_infrared = random.below(2) == 1;
    for (int k = 0; k < 4; ++k) {
        Vec2 const low{random.uniform(100, 800), random.uniform(100, 500)};
        world.arena.polygons.push_back(box(low, low + Vec2{random.uniform(2, 60), random.uniform(2, 60)}));
    }
    for (int i = 0; i < 60; ++i) {
        auto const robot =
            add_robot(world, {random.uniform(0, 1000), random.uniform(0, 700)}, random.uniform(-kPi, kPi));
        world.bodies.radius_mm[robot] = random.uniform(5.0F, 30.0F);
    }
    for (int i = 0; i < 30; ++i) {
        add_blocker(world, random_shape(random), {random.uniform(-50, 1050), random.uniform(-50, 750)},
                    random.uniform(-kPi, kPi));
    }
    return world;
}

/// Bit d: emitter d of `robot` reaches the receiver. By receiver.
std::vector<unsigned> emitters_that_reach(World const& world, Visibility& visibility, std::uint32_t robot,
                                          float range_mm) {
    std::vector<unsigned> reach(world.robots.size(), 0);
    for (Receiver const& receiver : visibility.receivers(world, robot, kAllFaces, range_mm)) {
        reach[receiver.robot] = receiver.emitters;
    }
    return reach;
}

TEST(Blockers, LeaveWhatAllLinesPastAllImagesOfAllBodiesLeave) {
    RandomStream random(17, 0);
    std::array<int, 3> counts{};
    for (int scene = 0; scene < 30; ++scene) {
        World const world = random_world(random);
        World without = world;
        without.walls_block_infrared = false;
        for (BodySpec& spec : without.bodies.spec) {
            spec.blocks_infrared = false;
        }
        Visibility view;
        view.update(world);
        Visibility open_view;
        open_view.update(without);
        float const range_mm = random.below(5) == 0 ? random.uniform(300.0F, 900.0F) : random.uniform(40.0F, 200.0F);
        for (std::uint32_t robot = 0; robot < world.robots.size(); ++robot) {
            std::vector<unsigned> const open = emitters_that_reach(without, open_view, robot, range_mm);
            std::vector<unsigned> const left = emitters_that_reach(world, view, robot, range_mm);
            Vec2 const centre = world.bodies.position_mm[robot];
            for (std::uint32_t other = 0; other < world.robots.size(); ++other) {
                Vec2 const target = centre + minimum_image(world, centre, world.bodies.position_mm[other]);
                for (unsigned emitter = 0; emitter < kMostFaces; ++emitter) {
                    if ((open[other] >> emitter & 1U) == 0) {
                        EXPECT_EQ(left[other] >> emitter & 1U, 0U) << "blockers only take away";
                        continue;
                    }
                    Vec2 const place = centre + rotate(world.bodies.radius_mm[robot] *
                                                           direction(static_cast<float>(emitter) * kPi / 2),
                                                       world.bodies.heading_dir[robot]);
                    Sight const sight = worse(sight_along(world, centre, place), sight_along(world, place, target));
                    ++counts[static_cast<std::size_t>(sight)];
                    if (sight != Sight::unclear) {
                        ASSERT_EQ((left[other] >> emitter & 1U) != 0, sight == Sight::open)
                            << "scene " << scene << ": emitter " << emitter << " of " << robot << " to " << other
                            << ", periodic " << world.periodic << ", range " << range_mm;
                    }
                }
            }
        }
    }
    EXPECT_GT(counts[0], 1000);
    EXPECT_GT(counts[1], 1000);
    EXPECT_LT(counts[2], counts[0] / 20);
}

}  // namespace
}  // namespace pogosim
