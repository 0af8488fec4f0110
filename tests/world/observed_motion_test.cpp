// What bodies really did in the last step.
#include "world/observed_motion.hpp"

#include <gtest/gtest.h>

#include "support/small_world.hpp"

namespace pogosim {
namespace {

TEST(ObservedMotion, IsTheDisplacementAndTheTurnByTheDurationOfAStep) {
    World world = testing::square_world();
    std::uint32_t const robot = testing::add_robot(world, {200, 200}, 1.0F);
    world.time_step_s = 0.5;
    world.bodies.velocity_mm_s[robot] = {100, 100};  // what an engine goes on with
    EXPECT_EQ(observed_motion(world, robot).velocity_mm_s, Vec2{});
    world.bodies.position_mm[robot] = {201, 198};
    world.bodies.heading_rad[robot] = 1.25F;
    ObservedMotion const motion = observed_motion(world, robot);
    EXPECT_EQ(motion.velocity_mm_s, (Vec2{2, -4}));
    EXPECT_EQ(motion.angular_velocity_rad_s, 0.5F);
}

TEST(ObservedMotion, EqualsTheEnginesVelocityToTheLastBitIfTheBodyMovedByIt) {
    World world = testing::square_world();
    std::uint32_t const robot = testing::add_robot(world, {987.654F, 321.012F}, 1.0F);
    Vec2 const velocity{73.3F, -12.1F};
    world.bodies.velocity_mm_s[robot] = velocity;
    world.bodies.position_mm[robot] =
        world.bodies.position_mm[robot] + static_cast<float>(world.time_step_s) * velocity;
    EXPECT_EQ(observed_motion(world, robot).velocity_mm_s, velocity);
}

TEST(ObservedMotion, CrossesTheSeamOfAPeriodicWorldTheShortWay) {
    World world = testing::square_world();
    world.periodic = true;
    world.time_step_s = 0.5;
    std::uint32_t const robot = testing::add_robot(world, {999, 500});
    world.bodies.position_mm[robot] = {2, 500};
    EXPECT_NEAR(observed_motion(world, robot).velocity_mm_s.x, 6.0F, 1e-3F);
}

/// Headings are wrapped at half a turn; a body may turn by more than that in a step.
TEST(ObservedMotion, CountsTheTurnsOfAWrappedHeading) {
    for (float const velocity_rad_s : {2.0F, -2.0F, 20.0F, -50.0F}) {
        World world = testing::square_world();
        world.time_step_s = 0.5;
        std::uint32_t const robot = testing::add_robot(world, {200, 200}, 3.0F);
        world.bodies.angular_velocity_rad_s[robot] = 1.1F * velocity_rad_s;  // a contact has braked it a little
        world.bodies.heading_rad[robot] = wrap_angle(3.0F + 0.5F * velocity_rad_s);
        EXPECT_NEAR(observed_motion(world, robot).angular_velocity_rad_s, velocity_rad_s, 1e-4F);
    }
}

TEST(ObservedMotion, OfABodyMovedByHandIsZero) {
    World world = testing::square_world();
    std::uint32_t const robot = testing::add_robot(world, {200, 200});
    world.bodies.position_mm[robot] = {201, 200};
    set_pose(world.bodies, robot, {700, 700}, 2.0F);
    EXPECT_EQ(observed_motion(world, robot).velocity_mm_s, Vec2{});
    EXPECT_EQ(observed_motion(world, robot).angular_velocity_rad_s, 0.0F);
}

TEST(ObservedMotion, OfAMembraneIsTheMeanOfItsBodies) {
    World world = testing::square_world();
    world.time_step_s = 0.5;
    for (float const x : {200.0F, 300.0F, 400.0F}) {
        testing::add_body(world, {x, 200}, 0.0F, testing::pogobot_spec());
    }
    for (std::uint32_t body = 0; body < 3; ++body) {
        world.bodies.position_mm[body] = world.bodies.position_mm[body] + Vec2{2, static_cast<float>(body)};
    }
    ObservedMotion const motion = observed_motion(world, Object{.body = 0, .body_count = 3});
    EXPECT_NEAR(motion.velocity_mm_s.x, 4.0F, 1e-3F);
    EXPECT_NEAR(motion.velocity_mm_s.y, 2.0F, 1e-3F);
    EXPECT_EQ(motion.angular_velocity_rad_s, 0.0F);
}

TEST(ObservedMotion, ObjectWithoutABodyStands) {
    World const world = testing::square_world();
    EXPECT_EQ(observed_motion(world, Object{}).velocity_mm_s, Vec2{});
}

}  // namespace
}  // namespace pogosim
