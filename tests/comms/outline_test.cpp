// Infrared along the outlines of walls and membranes: the robots within a distance of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numbers>
#include <vector>

#include "base/random.hpp"
#include "comms/visibility.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_membrane;
using testing::add_robot;
using testing::add_wall;
using testing::square_world;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kRadius = 26.5F;
constexpr float kRange = 80.0F;  // of robots
constexpr std::uint8_t kFront = 1;
constexpr std::uint8_t kRight = 2;
constexpr std::uint8_t kBack = 4;
constexpr std::uint8_t kLeft = 8;

Polygon box(Vec2 low, Vec2 high) {
    return {low, {high.x, low.y}, high, {low.x, high.y}};
}

Polygon circle(Vec2 centre, float radius_mm, int corners = 400) {
    return moved(outline({.kind = ShapeKind::disk, .radius_mm = radius_mm}, corners), centre, 0.0F);
}

/// Faces of `robot` at which a message of the wall arrives.
std::uint8_t hears(World const& world, std::uint32_t robot, std::uint32_t wall) {
    Visibility visibility;
    visibility.update(world);
    auto const receivers = visibility.receivers(world, wall, kAllFaces, world.spec_of(wall).ir.range_mm);
    auto const found = std::ranges::find(receivers, robot, &Receiver::robot);
    return found == receivers.end() ? std::uint8_t{0} : found->faces;
}

bool reaches(World const& world, std::uint32_t robot, std::uint32_t wall, std::uint8_t emitters = kAllFaces) {
    Visibility visibility;
    visibility.update(world);
    auto const receivers = visibility.receivers(world, robot, emitters, world.spec_of(robot).ir.range_mm);
    auto const found = std::ranges::find(receivers, wall, &Receiver::robot);
    EXPECT_TRUE(found == receivers.end() || found->faces == 1) << "an outline has one face, number 0";
    return found != receivers.end();
}

/// True when a robot at this place hears the wall and reaches it.
bool is_linked(Vec2 place, float heading_rad, std::vector<Polygon> const& polygons, float wall_range_mm = kRange) {
    World world = square_world(2000.0F);
    add_robot(world, place, heading_rad);
    std::uint32_t const wall = add_wall(world, polygons, wall_range_mm);
    bool const heard = hears(world, 0, wall) != 0;
    EXPECT_EQ(heard, reaches(world, 0, wall)) << place.x << ", " << place.y;
    return heard;
}

/// Expects the link to break between the two distances from the outline's middle `centre`, along +x.
void expect_limit(Vec2 centre, float limit_mm, std::vector<Polygon> const& polygons, bool linked_below) {
    constexpr float margin_mm = 0.05F;
    EXPECT_EQ(is_linked(centre + Vec2{limit_mm - margin_mm, 0}, 0.0F, polygons), linked_below) << limit_mm;
    EXPECT_EQ(is_linked(centre + Vec2{limit_mm + margin_mm, 0}, 0.0F, polygons), !linked_below) << limit_mm;
}

TEST(Outline, OriginalCopiesAreThoseOfEachFaceForEachFace) {
    World world = square_world(2000.0F);
    add_robot(world, {60, 60}, kPi / 4.0F);  // in the corner: two faces or more
    add_robot(world, {1000, 60});            // one wall
    add_robot(world, {1000, 1000});          // out of reach
    std::uint32_t const wall = add_wall(world, {box({0, 0}, {2000, 2000})});
    auto const times = [&world, wall](std::uint32_t robot, std::uint8_t emitters) {
        Visibility visibility;
        visibility.update(world);
        return std::ranges::count(visibility.receivers(world, wall, emitters, kRange), robot, &Receiver::robot);
    };
    for (std::uint32_t robot = 0; robot < 3; ++robot) {
        EXPECT_EQ(times(robot, kFront), robot < 2 ? 1 : 0);
    }
    world.original_wall_copies = true;
    for (std::uint32_t robot = 0; robot < 3; ++robot) {
        int const faces = std::popcount(hears(world, robot, wall));
        EXPECT_EQ(faces > 1, robot < 2);
        EXPECT_EQ(times(robot, kFront), faces);  // each of these then arrives at each face
        EXPECT_EQ(times(robot, kRight), 0);
        EXPECT_EQ(times(robot, kAllFaces), faces > 0 ? 1 : 0);
    }
}

TEST(Outline, StraightWallIsHeardWithinTheRangeOfAnEmitter) {
    std::vector<Polygon> const wall{box({0, 0}, {2000, 2000})};
    // The emitter nearest to the right wall is the front one, one radius ahead of the centre.
    expect_limit({0, 1000}, 2000.0F - kRange - kRadius, wall, false);
    // At 45 degrees, two of them are nearest.
    float const turned = 2000.0F - kRange - kRadius * std::numbers::sqrt2_v<float> / 2.0F;
    EXPECT_FALSE(is_linked({turned - 0.05F, 1000}, kPi / 4.0F, wall));
    EXPECT_TRUE(is_linked({turned + 0.05F, 1000}, kPi / 4.0F, wall));
}

TEST(Outline, RoundWallIsHeardFromBothSides) {
    std::vector<Polygon> const wall{circle({1000, 1000}, 400.0F)};
    expect_limit({1000, 1000}, 400.0F - kRange - kRadius, wall, false);
    expect_limit({1000, 1000}, 400.0F + kRange + kRadius, wall, true);
}

TEST(Outline, HolesBelongToTheWall) {
    std::vector<Polygon> const annulus{circle({1000, 1000}, 900.0F), circle({1000, 1000}, 300.0F)};
    expect_limit({1000, 1000}, 300.0F + kRange + kRadius, annulus, true);
    expect_limit({1000, 1000}, 900.0F - kRange - kRadius, annulus, false);
    EXPECT_FALSE(is_linked({1600, 1000}, 0.0F, annulus));
}

TEST(Outline, CornerOfAWallIsHeardAtItsDistance) {
    // A robot outside of a box, on the diagonal, looking at the corner.
    std::vector<Polygon> const wall{box({500, 500}, {1000, 1000})};
    float const limit_mm = kRange + kRadius;
    Vec2 const out = direction(kPi / 4.0F);
    EXPECT_TRUE(is_linked(Vec2{1000, 1000} + (limit_mm - 0.05F) * out, kPi / 4.0F, wall));
    EXPECT_FALSE(is_linked(Vec2{1000, 1000} + (limit_mm + 0.05F) * out, kPi / 4.0F, wall));
}

TEST(Outline, RobotHearsAWallWithinTheSmallerOfBothRanges) {
    for (float const wall_range_mm : {30.0F, 200.0F}) {
        World world = square_world(2000.0F);
        float const gap_mm = wall_range_mm < kRange ? 50.0F : 100.0F;  // between both ranges
        add_robot(world, {2000.0F - kRadius - gap_mm, 1000});
        std::uint32_t const wall = add_wall(world, {box({0, 0}, {2000, 2000})}, wall_range_mm);
        EXPECT_EQ(hears(world, 0, wall), 0) << wall_range_mm;
        // The wall hears as far as the robot reaches, whatever its own range.
        EXPECT_EQ(reaches(world, 0, wall), gap_mm < kRange) << wall_range_mm;
    }
}

TEST(Outline, OneCopyArrivesAtEachFaceInRange) {
    World world = square_world(2000.0F);
    add_robot(world, {2000.0F - 40.0F, 1000});  // front 13.5 mm, sides 40 mm, back 66.5 mm from the wall
    add_robot(world, {2000.0F - 90.0F, 500});   // only the front within 80 mm... and no other
    add_robot(world, {90.0F, 500});             // only the back
    add_robot(world, {1000, 90.0F});            // only the left one
    add_robot(world, {1000, 90.0F}, kPi);       // turned round: only the right one
    std::uint32_t const wall = add_wall(world, {box({0, 0}, {2000, 2000})});
    EXPECT_EQ(hears(world, 0, wall), kAllFaces);
    EXPECT_EQ(hears(world, 1, wall), kFront);
    EXPECT_EQ(hears(world, 2, wall), kBack);
    EXPECT_EQ(hears(world, 3, wall), kLeft);
    EXPECT_EQ(hears(world, 4, wall), kRight);
}

TEST(Outline, RobotReachesAWallThroughTheEmittersInRangeOnly) {
    World world = square_world(2000.0F);
    add_robot(world, {2000.0F - 90.0F, 500});
    std::uint32_t const wall = add_wall(world, {box({0, 0}, {2000, 2000})});
    EXPECT_TRUE(reaches(world, 0, wall, kFront));
    EXPECT_FALSE(reaches(world, 0, wall, kRight | kBack | kLeft));
}

TEST(Outline, RobotsDoNotHideWalls) {
    World world = square_world(2000.0F);
    add_robot(world, {2000.0F - 90.0F, 500});
    add_robot(world, {2000.0F - 30.0F, 500});  // between the first one and the wall
    std::uint32_t const wall = add_wall(world, {box({0, 0}, {2000, 2000})});
    EXPECT_TRUE(reaches(world, 0, wall));
    EXPECT_EQ(hears(world, 0, wall), kFront);
}

TEST(Outline, IgnoringOcclusionsChangesNothing) {
    for (bool const ignore : {false, true}) {
        World world = square_world(2000.0F);
        world.ignore_occlusions = ignore;
        add_robot(world, {2000.0F - 90.0F, 500});
        std::uint32_t const wall = add_wall(world, {box({0, 0}, {2000, 2000})});
        EXPECT_EQ(hears(world, 0, wall), kFront);
        EXPECT_TRUE(reaches(world, 0, wall));
        EXPECT_FALSE(reaches(world, 0, wall, kLeft));
    }
}

TEST(Outline, WallSendsByItsOnlyEmitter) {
    World world = square_world(2000.0F);
    add_robot(world, {1950, 500});
    std::uint32_t const wall = add_wall(world, {box({0, 0}, {2000, 2000})});
    Visibility visibility;
    visibility.update(world);
    EXPECT_EQ(visibility.receivers(world, wall, kFront, kRange).size(), 1U);
    EXPECT_TRUE(visibility.receivers(world, wall, kRight | kBack | kLeft, kRange).empty());
    EXPECT_TRUE(visibility.receivers(world, wall, kAllFaces, 0.0F).empty());  // power 0
}

TEST(Outline, HeadOnALargeBodySendsFromItsCentre) {
    World world = square_world(2000.0F);
    ObjectSpec pogobject = testing::pogobot_spec();
    pogobject.shape.radius_mm = 100.0F;
    pogobject.robot->model = head_model();
    add_robot(world, {1000, 1000}, 0.0F, pogobject);
    add_robot(world, {1000.0F + 100.0F + kRange - 0.1F, 1000}, 0.0F, pogobject);
    add_robot(world, {1000, 1000.0F + 100.0F + kRange + 0.1F}, 0.0F, pogobject);
    Visibility visibility;
    visibility.update(world);
    // From the centre to the receiver's border.
    auto const receivers = visibility.receivers(world, 0, kAllFaces, kRange);
    ASSERT_EQ(receivers.size(), 1U);
    EXPECT_EQ(receivers[0].robot, 1U);
    EXPECT_NEAR(receivers[0].from_emitter_mm.x, 100.0F + kRange - 0.1F, 0.01F);
    // So does a wall see it: nothing but the centre's distance counts, and all faces receive.
    World beside = square_world(2000.0F);
    add_robot(beside, {2000.0F - kRange + 0.1F, 1000}, 0.3F, pogobject);
    add_robot(beside, {2000.0F - kRange - 0.1F, 500}, 0.3F, pogobject);
    std::uint32_t const wall = add_wall(beside, {box({0, 0}, {2000, 2000})});
    EXPECT_EQ(hears(beside, 0, wall), kAllFaces);
    EXPECT_TRUE(reaches(beside, 0, wall));
    EXPECT_EQ(hears(beside, 1, wall), 0);
    EXPECT_FALSE(reaches(beside, 1, wall));
}

TEST(Outline, OfAMembraneMovesWithIt) {
    World world = square_world(2000.0F);
    add_robot(world, {1000, 1000});
    std::uint32_t const membrane = add_membrane(world, circle({1000, 1000}, 100.0F, 60));
    Visibility visibility;
    visibility.update(world);
    EXPECT_EQ(visibility.receivers(world, membrane, kAllFaces, kRange).size(), 1U);
    for (std::size_t i = 1; i < world.bodies.position_mm.size(); ++i) {
        world.bodies.position_mm[i].x += 300.0F;
    }
    visibility.update(world);
    EXPECT_TRUE(visibility.receivers(world, membrane, kAllFaces, kRange).empty());
    for (std::size_t i = 1; i < world.bodies.position_mm.size(); ++i) {
        world.bodies.position_mm[i].x -= 150.0F;  // its left end is at 1050: 23.5 mm ahead of the robot's front
    }
    visibility.update(world);
    auto const receivers = visibility.receivers(world, membrane, kAllFaces, kRange);
    ASSERT_EQ(receivers.size(), 1U);
    EXPECT_EQ(receivers[0].faces, kAllFaces);  // the back one is 76.5 mm away
}

TEST(Outline, EdgeBetweenTwoDotsOfAMembraneSendsToo) {
    World world = square_world(2000.0F);
    add_robot(world, {1000, 1000});
    // Four dots, far from the robot; the left edge passes 60 mm in front of it.
    std::uint32_t const membrane = add_membrane(world, box({1000.0F + kRadius + 60.0F, 600}, {1600, 1400}));
    EXPECT_EQ(hears(world, 0, membrane), kFront);
    EXPECT_TRUE(reaches(world, 0, membrane));
}

TEST(Outline, OfAMembraneOnTheSeamIsHeardFromBothSides) {
    // A ring around the corner of a periodic world: parts of it stand beyond the bounds on all sides.
    for (Vec2 const corner : {Vec2{0, 0}, Vec2{2000, 0}, Vec2{0, 2000}, Vec2{2000, 2000}}) {
        World world = square_world(2000.0F);
        world.periodic = true;
        constexpr float in_reach_mm = 300.0F + kRadius + 20.0F;
        std::vector<Vec2> const around{{in_reach_mm, 10},          {2000 - in_reach_mm, 10},
                                       {in_reach_mm, 1990},        {2000 - in_reach_mm, 1990},
                                       {10, in_reach_mm},          {1990, in_reach_mm},
                                       {10, 2000 - in_reach_mm},   {1990, 2000 - in_reach_mm},
                                       {in_reach_mm + 100.0F, 10}, {10, 1000}};
        for (Vec2 const place : around) {
            add_robot(world, place);
        }
        std::uint32_t const membrane = add_membrane(world, circle(corner, 300.0F, 200));
        for (std::uint32_t robot = 0; robot < around.size(); ++robot) {
            EXPECT_EQ(hears(world, robot, membrane) != 0, robot < 8) << corner.x << ", " << corner.y << ": " << robot;
            EXPECT_EQ(reaches(world, robot, membrane), robot < 8) << corner.x << ", " << corner.y << ": " << robot;
        }
    }
}

TEST(Outline, IndexFindsWhatTheDistanceToThePolygonsSays) {
    for (bool const periodic : {false, true}) {
        RandomStream random(5, 1);
        World world = square_world(1500.0F);
        world.periodic = periodic;
        constexpr std::uint32_t robots = 200;
        for (std::uint32_t i = 0; i < robots; ++i) {
            add_robot(world, {random.uniform(0, 1500), random.uniform(0, 1500)}, random.uniform(-kPi, kPi));
        }
        std::vector<Polygon> const lines{circle({400, 500}, 250.0F, 37), box({900, 200}, {1400, 260}),
                                         circle({periodic ? 1450.0F : 1200.0F, 1100}, 220.0F, 90)};
        std::vector<std::uint32_t> outlines{add_wall(world, {lines[0]}, 120.0F), add_wall(world, {lines[1]}, 40.0F)};
        outlines.push_back(add_membrane(world, lines[2], 60.0F));
        for (std::size_t k = 0; k < lines.size(); ++k) {
            float const range_mm = std::min(kRange, world.spec_of(outlines[k]).ir.range_mm);
            for (std::uint32_t i = 0; i < robots; ++i) {
                std::uint8_t faces = 0;
                bool reached = false;
                for (unsigned face = 0; face < kMostFaces; ++face) {
                    float const angle = world.bodies.heading_rad[i] + static_cast<float>(face) * kPi / 2.0F;
                    Vec2 const emitter = world.bodies.position_mm[i] + kRadius * direction(angle);
                    float distance_mm = 1e9F;
                    for (float const dx : {-1500.0F, 0.0F, 1500.0F}) {
                        Vec2 const image = emitter + Vec2{periodic ? dx : 0.0F, 0.0F};
                        distance_mm = std::min(distance_mm, distance_to_outline(lines[k], image));
                    }
                    faces = static_cast<std::uint8_t>(faces | (distance_mm <= range_mm ? 1U << face : 0U));
                    reached = reached || distance_mm <= kRange;
                }
                EXPECT_EQ(hears(world, i, outlines[k]), faces) << "robot " << i << ", outline " << k;
                EXPECT_EQ(reaches(world, i, outlines[k]), reached) << "robot " << i << ", outline " << k;
            }
        }
    }
}

}  // namespace
}  // namespace pogosim
