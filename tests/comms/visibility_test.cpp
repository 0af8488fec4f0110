#include "comms/visibility.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "base/random.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_robot;
using testing::square_world;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kRadius = 26.5F;
constexpr std::uint8_t kFront = 1;
constexpr std::uint8_t kRight = 2;
constexpr std::uint8_t kBack = 4;
constexpr std::uint8_t kLeft = 8;

std::vector<std::uint32_t> reached(World const& world, std::uint32_t robot, std::uint8_t emitters) {
    Visibility visibility;
    visibility.update(world);
    std::vector<std::uint32_t> result;
    for (Receiver const& receiver : visibility.receivers(world, robot, emitters, world.spec_of(robot).ir.range_mm)) {
        result.push_back(receiver.robot);
    }
    return result;
}

using Robots = std::vector<std::uint32_t>;

std::uint8_t seeing_faces(Vec2 emitter_mm) {
    return faces_that_see(make_faces(RobotModel(), kRadius), emitter_mm, 80.0F, /*in_any_direction=*/false);
}

TEST(Visibility, RobotThatIsSwitchedOffReceivesNothingAndStillCoversOthers) {
    World world = square_world();
    add_robot(world, {500, 500});
    add_robot(world, {560, 500});
    add_robot(world, {615, 500});  // in the shadow of robot 1
    add_robot(world, {500, 560});
    EXPECT_EQ(reached(world, 0, kAllFaces), (Robots{1, 3}));
    world.switched_off = {1};
    EXPECT_EQ(reached(world, 0, kAllFaces), Robots{3});
    world.switched_off = {1, 3};
    EXPECT_EQ(reached(world, 0, kAllFaces), Robots{});
}

TEST(Visibility, RangeGoesFromTheEmitterToTheReceiversBorder) {
    // Centre distance at which the front emitter just reaches: radius + range + radius.
    float const limit = kRadius + 80.0F + kRadius;
    World near = square_world();
    add_robot(near, {500, 500});
    add_robot(near, {500 + limit - 0.01F, 500});
    EXPECT_EQ(reached(near, 0, kFront), Robots{1});

    World far = square_world();
    add_robot(far, {500, 500});
    add_robot(far, {500 + limit + 0.01F, 500});
    EXPECT_TRUE(reached(far, 0, kAllFaces).empty());
}

TEST(Visibility, EachEmitterShinesToItsOwnSide) {
    World world = square_world();
    add_robot(world, {500, 500}, 0.0F);
    add_robot(world, {600, 500});  // ahead
    add_robot(world, {500, 600});  // below on the screen: to the right
    add_robot(world, {400, 500});  // behind
    add_robot(world, {500, 400});  // to the left
    EXPECT_EQ(reached(world, 0, kFront), Robots{1});
    EXPECT_EQ(reached(world, 0, kRight), Robots{2});
    EXPECT_EQ(reached(world, 0, kBack), Robots{3});
    EXPECT_EQ(reached(world, 0, kLeft), Robots{4});
    EXPECT_EQ(reached(world, 0, kAllFaces), (Robots{1, 2, 3, 4}));
}

TEST(Visibility, EmitterReachesCentresInFrontOfTheTangentAtItsPlace) {
    // The half plane of an emitter begins where it sits, 26.5 mm from the robot's centre.
    std::array const emitters{kFront, kRight, kBack, kLeft};
    for (std::size_t i = 0; i < emitters.size(); ++i) {
        float const direction = static_cast<float>(i) * kPi / 2.0F;
        for (float const ahead_mm : {-0.05F, 0.05F}) {
            World world = square_world();
            add_robot(world, {500, 500});
            add_robot(world,
                      Vec2{500, 500} + rotate({kRadius + ahead_mm, 60.0F}, {std::cos(direction), std::sin(direction)}));
            EXPECT_EQ(reached(world, 0, emitters[i]), ahead_mm > 0.0F ? Robots{1} : Robots{}) << i << ": " << ahead_mm;
        }
    }
}

TEST(Visibility, EmittersTurnWithTheRobot) {
    World world = square_world();
    add_robot(world, {500, 500}, kPi / 2.0F);  // heading down the screen
    add_robot(world, {500, 600});
    add_robot(world, {400, 500});
    EXPECT_EQ(reached(world, 0, kFront), Robots{1});
    EXPECT_EQ(reached(world, 0, kRight), Robots{2});
}

TEST(Visibility, NearRobotHidesTheOneStraightBehindIt) {
    World world = square_world();
    add_robot(world, {500, 500});
    add_robot(world, {555, 500});
    add_robot(world, {609, 500});
    EXPECT_EQ(reached(world, 0, kAllFaces), Robots{1});
    world.ignore_occlusions = true;
    EXPECT_EQ(reached(world, 0, kAllFaces), (Robots{1, 2}));
}

TEST(Visibility, PartlyHiddenRobotIsSeen) {
    World world = square_world();
    add_robot(world, {500, 500});
    add_robot(world, {590, 480});  // hides bearings of -41 to 6 degrees from the front emitter
    add_robot(world, {612, 530});  // spans 2 to 36 degrees
    EXPECT_EQ(reached(world, 0, kFront), (Robots{1, 2}));
}

TEST(Visibility, TwoShadowsThatTouchHideWhatNeitherHidesAlone) {
    World world = square_world();
    add_robot(world, {500, 500});
    add_robot(world, {560, 526});
    add_robot(world, {560, 474});
    add_robot(world, {625, 500});
    EXPECT_EQ(reached(world, 0, kFront), (Robots{1, 2}));
}

TEST(Visibility, OmnidirectionalTransmissionComesFromTheNearestEmitterThatSees) {
    World world = square_world();
    add_robot(world, {500, 500});
    add_robot(world, {580, 540});
    Visibility visibility;
    visibility.update(world);
    auto const receivers = visibility.receivers(world, 0, kAllFaces, world.spec_of(0).ir.range_mm);
    ASSERT_EQ(receivers.size(), 1U);
    // The front emitter at (526.5, 500) is nearer than the right one at (500, 526.5).
    EXPECT_NEAR(receivers[0].from_emitter_mm.x, 580.0F - 526.5F, 1e-3F);
    EXPECT_NEAR(receivers[0].from_emitter_mm.y, 40.0F, 1e-3F);
}

TEST(Visibility, PeriodicWorldIsSeenAcrossTheSeam) {
    World world = square_world();
    add_robot(world, {980, 500});
    add_robot(world, {60, 500});
    EXPECT_TRUE(reached(world, 0, kAllFaces).empty());
    world.periodic = true;
    EXPECT_EQ(reached(world, 0, kFront), Robots{1});
    EXPECT_EQ(reached(world, 1, kBack), Robots{0});
}

TEST(Visibility, RobotWithoutRangeIsMute) {
    World world = square_world();
    ObjectSpec mute = testing::pogobot_spec();
    mute.robot->ir.range_mm = 0.0F;
    add_robot(world, {500, 500}, 0.0F, mute);
    add_robot(world, {553, 500}, 0.0F, mute);
    EXPECT_TRUE(reached(world, 0, kAllFaces).empty());
}

TEST(Visibility, WithoutOcclusionsTheGridFindsWhatAllPairsFind) {
    for (bool const periodic : {false, true}) {
        World world = square_world();
        world.periodic = periodic;
        world.ignore_occlusions = true;
        RandomStream random(7, 1);
        for (int i = 0; i < 150; ++i) {
            add_robot(world, {random.uniform(0, 1000), random.uniform(0, 1000)}, random.uniform(-kPi, kPi));
        }
        for (std::uint32_t i = 0; i < 150; ++i) {
            Robots expected;
            for (std::uint32_t j = 0; j < 150; ++j) {
                bool in_reach = false;
                for (int emitter = 0; emitter < static_cast<int>(kMostFaces); ++emitter) {
                    float const angle = world.bodies.heading_rad[i] + static_cast<float>(emitter) * kPi / 2.0F;
                    Vec2 const point = world.bodies.position_mm[i] + kRadius * direction(angle);
                    Vec2 const d = minimum_image(world, point, world.bodies.position_mm[j]);
                    in_reach = in_reach || length(d) <= 80.0F + kRadius;
                }
                if (j != i && in_reach) {
                    expected.push_back(j);
                }
            }
            EXPECT_EQ(reached(world, i, kAllFaces), expected) << "robot " << i << ", periodic " << periodic;
        }
    }
}

TEST(Faces, EmitterStraightAheadIsSeenByTheFrontFaceOnly) {
    EXPECT_EQ(seeing_faces({60, 0}), kFront);
    EXPECT_EQ(seeing_faces({0, 60}), kRight);
    EXPECT_EQ(seeing_faces({-60, 0}), kBack);
    EXPECT_EQ(seeing_faces({0, -60}), kLeft);
}

TEST(Faces, SeeWhatIsInFrontOfTheTangentAtTheirPlace) {
    for (float const across_mm : {-40.0F, 40.0F}) {
        unsigned const beside = across_mm > 0.0F ? kRight : kLeft;
        EXPECT_EQ(seeing_faces({kRadius + 0.05F, across_mm}), kFront | beside);
        EXPECT_EQ(seeing_faces({kRadius - 0.05F, across_mm}), beside);
        EXPECT_EQ(seeing_faces({-kRadius - 0.05F, across_mm}), kBack | beside);
        EXPECT_EQ(seeing_faces({-kRadius + 0.05F, across_mm}), beside);
    }
}

TEST(Faces, EmitterOnTheDiagonalIsSeenByBothFacesBesideIt) {
    World world = square_world();
    add_robot(world, {500, 500}, kPi / 2.0F);  // front points down the screen, right to the left of it
    Visibility visibility;
    visibility.update(world);
    Receiver const receiver{.robot = 0, .from_emitter_mm = {50, -50}};
    EXPECT_EQ(visibility.faces_of(world, receiver, 80.0F), kFront | kRight);
}

TEST(Faces, AtLeastOneFaceReceives) {
    // Close by on the diagonal, behind the plane of every face.
    EXPECT_EQ(seeing_faces({20, 19}), kFront);
    // Seen by the front face, but out of its reach.
    EXPECT_EQ(seeing_faces({200, 0}), kFront);
}

}  // namespace
}  // namespace pogosim
