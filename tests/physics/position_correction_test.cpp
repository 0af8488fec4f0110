// Walls hold bodies that are moved by hand, without an engine that pushes them out.
#include "physics/position_correction.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <utility>

#include "base/random.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

/// A disk in an arena, without an engine.
class Held {
public:
    Held(Arena arena, Vec2 place_mm, float radius_mm) : place_mm_(place_mm) {
        World world;
        world.arena = std::move(arena);
        ObjectSpec spec = testing::pogobot_spec();
        spec.shape.radius_mm = radius_mm;
        testing::add_robot(world, place_mm, 0.0F, spec);
        position_correction_.emplace(world);
    }

    /// Moves it and returns where it is then.
    Vec2 move(Vec2 by_mm) { return place_mm_ = position_correction_->hold(0, place_mm_ + by_mm); }

    Vec2 place() const { return place_mm_; }

private:
    Vec2 place_mm_;
    std::optional<PositionCorrection> position_correction_;
};

Arena square() {
    return make_arena({{{0, 0}, {1000, 0}, {1000, 1000}, {0, 1000}}});
}

void expect_at(Vec2 place, Vec2 expected_mm) {
    EXPECT_NEAR(place.x, expected_mm.x, 0.01F);
    EXPECT_NEAR(place.y, expected_mm.y, 0.01F);
}

TEST(PositionCorrection, LeavesBodiesAloneThatDoNotSinkIntoAWall) {
    Held disk(square(), {500, 500}, 20.0F);
    expect_at(disk.move({300, -100}), {800, 400});
    expect_at(disk.move({185, 0}), {985, 400});  // by a quarter of its radius
}

TEST(PositionCorrection, PutsBackWhatJumpsAWall) {
    Held disk(square(), {500, 500}, 20.0F);
    expect_at(disk.move({5000, 0}), {980, 500});
}

TEST(PositionCorrection, HoldsWhatCreepsThroughAWallInStepsMuchSmallerThanItself) {
    Held disk(square(), {500, 500}, 20.0F);
    for (int i = 0; i < 2000; ++i) {
        Vec2 const place = disk.move({0.5F, 0});
        ASSERT_LT(place.x, 990.5F) << "step " << i;
    }
    EXPECT_GT(disk.place().x, 975.0F);
}

TEST(PositionCorrection, LetsWhatHitsAWallAtAnAngleGoOnAlongIt) {
    Held disk(square(), {500, 900}, 20.0F);
    expect_at(disk.move({300, 400}), {800, 980});
}

TEST(PositionCorrection, StopsInACornerWhatSlidesAlongOneWallToTheNext) {
    Held disk(square(), {500, 900}, 20.0F);
    expect_at(disk.move({2000, 400}), {980, 980});
}

TEST(PositionCorrection, HoldsSpecksInAnArenaWhereNumbersAreCoarse) {
    // A float has steps of 0.06 mm here, and the walls are oblique.
    constexpr float kSide = 1e6F;
    Arena const arena =
        make_arena({{{0, 0.31F * kSide}, {0.57F * kSide, 0}, {kSide, 0.43F * kSide}, {0.29F * kSide, kSide}}});
    RandomStream random(3, 0);
    Held speck(arena, {0.5F * kSide, 0.5F * kSide}, 1e-6F);
    for (int i = 0; i < 3000; ++i) {
        Vec2 const place = speck.move({kSide * random.normal(), kSide * random.normal()});
        ASSERT_TRUE(arena.contains(place)) << i;
        // 8e-6 of the largest coordinate, at least half of it.
        ASSERT_GT(arena.distance_to_walls(place), 3.5F) << i;
    }
}

}  // namespace
}  // namespace pogosim
