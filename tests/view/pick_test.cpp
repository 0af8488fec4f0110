#include "view/pointer.hpp"

#include <gtest/gtest.h>

namespace pogosim {
namespace {

constexpr float kRadiusMm = 20.0F;

/// Objects with bodies at these places, the first ones robots.
Snapshot snapshot_of(std::vector<Vec2> const& places, std::uint32_t robot_count) {
    auto scenery = std::make_shared<Scenery>();
    Snapshot snapshot;
    for (std::uint32_t i = 0; i < places.size(); ++i) {
        bool const is_robot = i < robot_count;
        scenery->objects.push_back({.robot = is_robot ? i : kNone, .body = i, .body_count = 1});
        scenery->body_radius_mm.push_back(kRadiusMm);
        snapshot.position_mm.push_back(places[i]);
    }
    scenery->objects.push_back({.fixed_mm = {500.0F, 500.0F}});  // a wall
    snapshot.scenery = scenery;
    return snapshot;
}

TEST(Pick, TheNearestOfTwoRobotsIsTaken) {
    Snapshot const snapshot = snapshot_of({{100, 100}, {130, 100}}, 2);
    EXPECT_EQ(robot_at(snapshot, {112, 100}, 0.0F), 0U);
    EXPECT_EQ(robot_at(snapshot, {118, 100}, 0.0F), 1U);
}

TEST(Pick, ARobotIsHitUpToItsRimAndAMargin) {
    Snapshot const snapshot = snapshot_of({{100, 100}}, 1);
    EXPECT_EQ(robot_at(snapshot, {119.5F, 100}, 0.0F), 0U);
    EXPECT_EQ(robot_at(snapshot, {121, 100}, 0.0F), std::nullopt);
    EXPECT_EQ(robot_at(snapshot, {121, 100}, 2.0F), 0U);
}

TEST(Pick, PassiveObjectsAreNoRobotsButCanBeGrasped) {
    Snapshot const snapshot = snapshot_of({{100, 100}, {300, 100}}, 1);
    EXPECT_EQ(robot_at(snapshot, {300, 100}, 5.0F), std::nullopt);
    EXPECT_EQ(object_at(snapshot, {300, 100}, 0.0F), 1U);
}

TEST(Pick, WallsCannotBeGrasped) {
    Snapshot const snapshot = snapshot_of({{100, 100}}, 1);
    EXPECT_EQ(object_at(snapshot, {500, 500}, 50.0F), std::nullopt);
}

}  // namespace
}  // namespace pogosim
