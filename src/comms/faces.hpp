// The faces of a robot, four at a time, one in each lane of a register.
#pragma once

#include <array>
#include <cstdint>

#include "base/four.hpp"
#include "base/vec2.hpp"
#include "world/robot_model.hpp"

namespace pogosim {

/// Faces of robots of one model and radius, in the robot's own frame. Lanes without a face are zero.
struct Faces {
    Four normal_x{};
    Four normal_y{};
    Four ahead_mm{};  // its place along its normal
    Four aside_mm{};  // and across it
    // Squares of the cosine of half the aperture: 0 for a half plane.
    Four emission_cosine2{};
    Four reception_cosine2{};
    std::array<Vec2, kMostFaces> place_mm{};
    float reach_mm = 0.0F;      // of the place that is farthest from the centre
    unsigned all = 0;           // bit d: there is a face d
    bool hears_around = false;  // whatever the direction, a face looks into it
};
static_assert(kMostFaces == kLanes);

Faces make_faces(RobotModel const& model, float radius_mm);

/// A point as the faces see it.
struct FaceView {
    Four x;  // along the normals, from their places
    Four y;
    Four distance_mm2;
};
inline FaceView seen_from(Faces const& faces, Vec2 point_mm) {
    Four const x = point_mm.x * faces.normal_x + point_mm.y * faces.normal_y - faces.ahead_mm;
    Four const y = faces.normal_x * point_mm.y - faces.normal_y * point_mm.x - faces.aside_mm;
    return {.x = x, .y = y, .distance_mm2 = x * x + y * y};
}

/// Lanes in which the point lies in the cones with these squared cosines.
inline FourInts is_in_cone(FaceView const& view, Four cosine2) {
    return (view.x >= 0.0F) & (view.x * view.x >= cosine2 * view.distance_mm2);
}

/// Faces that see an emitter at `emitter_mm` (relative to the robot's centre, in its own frame) within `range_mm`: bit
/// d for face d. If none does, since the emitter is behind all of their places, or nearer to the robot's border than to
/// a face: the face that points most towards it if the robot hears all around, or `in_any_direction`; else none.
std::uint8_t faces_that_see(Faces const& faces, Vec2 emitter_mm, float range_mm, bool in_any_direction);

}  // namespace pogosim
