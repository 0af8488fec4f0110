// Robots whose model has other faces than a Pogobot's.
#include "comms/faces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "comms/visibility.hpp"
#include "support/small_world.hpp"

namespace pogosim {
namespace {

using testing::add_robot;
using testing::square_world;

constexpr float kRadius = 26.5F;
constexpr double kDegree = std::numbers::pi / 180.0;

Face face_at(double angle_deg, float emission_deg = 180.0F, float reception_deg = 180.0F) {
    Vec2 const normal = direction_of_deg(angle_deg);
    return {.normal = normal, .place = {.radii = normal}, .emission_deg = emission_deg, .reception_deg = reception_deg};
}

ObjectSpec robot_with(std::vector<Face> faces) {
    ObjectSpec spec = testing::pogobot_spec();
    spec.robot->model.faces = std::move(faces);
    return spec;
}

/// Two robots: the first one, at the centre of the arena with the given faces, and one at this bearing from the place
/// of its first face. Returns the receivers of a message that the first one sends in all directions.
std::vector<Receiver> receivers_of(ObjectSpec const& spec, std::uint32_t sender, double bearing_deg,
                                   float distance_mm) {
    World world = square_world();
    Vec2 const centre{500, 500};
    Vec2 const place = centre + spec.robot->model.faces[0].place.at_mm(kRadius);
    add_robot(world, centre, 0.0F, spec);
    // The category is that of the first robot: the other one's faces point the same way, unless it is turned.
    add_robot(world, place + distance_mm * direction_of_deg(bearing_deg),
              static_cast<float>((bearing_deg + 180.0) * kDegree), spec);
    Visibility visibility;
    visibility.update(world);
    auto const found = visibility.receivers(world, sender, kAllFaces, 80.0F);
    return {found.begin(), found.end()};
}

TEST(Faces, OfThirtyDegreesSendsToCentresWithinFifteenDegreesOfItsNormal) {
    ObjectSpec const spec = robot_with({face_at(0.0, /*emission_deg=*/30.0F, /*reception_deg=*/180.0F)});
    for (double bearing_deg = -179.5; bearing_deg < 180.0; bearing_deg += 1.0) {
        bool const expected = std::abs(bearing_deg) < 15.0;
        EXPECT_EQ(receivers_of(spec, 0, bearing_deg, 90.0F).size(), expected ? 1U : 0U) << bearing_deg;
    }
}

TEST(Faces, OfThirtyDegreesHearsEmittersWithinFifteenDegreesOfItsNormal) {
    Faces const faces = make_faces(robot_with({face_at(60.0, 180.0F, 30.0F)}).robot->model, kRadius);
    Vec2 const place = kRadius * direction_of_deg(60.0);
    for (double bearing_deg = -119.5; bearing_deg < 240.0; bearing_deg += 1.0) {
        Vec2 const emitter_mm = place + 40.0F * direction_of_deg(bearing_deg);
        bool const expected = std::abs(bearing_deg - 60.0) < 15.0;
        EXPECT_EQ(faces_that_see(faces, emitter_mm, 80.0F, false), expected ? 1U : 0U) << bearing_deg;
    }
}

TEST(Faces, RobotThatHearsNowhereElseGetsNoMessageFromBehind) {
    ObjectSpec const spec = robot_with({face_at(0.0, 180.0F, 60.0F), face_at(180.0, 180.0F, 60.0F)});
    EXPECT_EQ(receivers_of(spec, 0, 0.0, 60.0F).size(), 1U);  // the second robot faces the first one
    World world = square_world();
    add_robot(world, {500, 500}, 0.0F, spec);
    add_robot(world, {590, 500}, std::numbers::pi_v<float> / 2.0F, spec);  // its faces look up and down the screen
    Visibility visibility;
    visibility.update(world);
    EXPECT_TRUE(visibility.receivers(world, 0, kAllFaces, 80.0F).empty());
    world.ignore_occlusions = true;
    visibility.update(world);
    EXPECT_EQ(visibility.receivers(world, 0, kAllFaces, 80.0F).size(), 1U);
}

TEST(Faces, OneToFourOfThemSendOnlyInTheirHalfPlanes) {
    for (std::size_t count = 1; count <= kMostFaces; ++count) {
        std::vector<Face> faces;
        for (std::size_t i = 0; i < count; ++i) {
            faces.push_back(face_at(360.0 * static_cast<double>(i) / static_cast<double>(count)));
        }
        ObjectSpec const spec = robot_with(faces);
        EXPECT_EQ(spec.robot->model.face_bits(), (1U << count) - 1U);
        for (double bearing_deg = 2.0; bearing_deg < 360.0; bearing_deg += 5.0) {
            World world = square_world();
            add_robot(world, {500, 500}, 0.0F, spec);
            Vec2 const offset = 80.0F * direction_of_deg(bearing_deg);
            add_robot(world, Vec2{500, 500} + offset, static_cast<float>((bearing_deg + 180.0) * kDegree), spec);
            Visibility visibility;
            visibility.update(world);
            unsigned seen = 0;
            for (std::size_t i = 0; i < count; ++i) {
                Vec2 const from_face = offset - kRadius * faces[i].normal;
                bool const is_ahead = dot(from_face, faces[i].normal) >= 0.0F;
                seen |= is_ahead && length(from_face) <= 80.0F + kRadius ? 1U << i : 0U;
            }
            auto const found = visibility.receivers(world, 0, kAllFaces, 80.0F);
            EXPECT_EQ(found.empty() ? 0U : found[0].emitters, seen) << count << " faces, " << bearing_deg;
        }
    }
}

TEST(Faces, SitWhereTheirPlacesAre) {
    Faces const faces =
        make_faces(robot_with({{.normal = {0.0F, 1.0F}, .place = {.offset_mm = {10.0F, 5.0F}}}}).robot->model, kRadius);
    EXPECT_EQ(faces.all, 1U);
    EXPECT_FLOAT_EQ(faces.reach_mm, std::sqrt(125.0F));
    FaceView const view = seen_from(faces, {10.0F, 45.0F});  // straight ahead of the face
    EXPECT_FLOAT_EQ(view.x[0], 40.0F);
    EXPECT_FLOAT_EQ(view.y[0], 0.0F);
    EXPECT_FLOAT_EQ(view.distance_mm2[0], 1600.0F);
}

TEST(Faces, OfAPogobotLookAroundAndNarrowOnesDoNot) {
    EXPECT_TRUE(make_faces(RobotModel(), kRadius).hears_around);
    EXPECT_TRUE(make_faces(head_model(), kRadius).hears_around);
    EXPECT_FALSE(make_faces(robot_with({face_at(0.0)}).robot->model, kRadius).hears_around);
    EXPECT_TRUE(make_faces(robot_with({face_at(0.0), face_at(180.0)}).robot->model, kRadius).hears_around);
    EXPECT_FALSE(
        make_faces(
            robot_with({face_at(0.0), face_at(120.0, 180.0F, 119.0F), face_at(240.0, 180.0F, 119.0F)}).robot->model,
            kRadius)
            .hears_around);
    EXPECT_TRUE(make_faces(robot_with({face_at(0.0, 30.0F, 120.0F), face_at(120.0, 30.0F, 120.0F),
                                       face_at(240.0, 30.0F, 120.0F)})
                               .robot->model,
                           kRadius)
                    .hears_around);
}

}  // namespace
}  // namespace pogosim
