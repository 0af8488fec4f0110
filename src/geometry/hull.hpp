// Convex polygons with rounded corners as they are tested against each other.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "geometry/rounded_polygon.hpp"

namespace pogosim {

inline constexpr std::uint32_t kMostCorners = 8;

/// All points within `radius_mm` of a convex polygon. A disk has one corner. A capsule, whose polygon is a line, has
/// four sides: along the line, across its end, back again, and across its start. The sides across have no length, but a
/// direction.
struct Hull {
    std::array<Vec2, kMostCorners> corner_mm{};  // clockwise on the screen
    std::array<Vec2, kMostCorners> outwards{};   // unit vector, of the side from this corner to the next one
    std::uint32_t count = 0;
    float radius_mm = 0.0F;
    Vec2 centre_mm;         // of a part of a compound, the part's centre of mass; else the origin
    float reach_mm = 0.0F;  // of the disk around it that holds all of the hull

    Vec2 next_corner_mm(std::uint32_t side) const { return corner_mm[side + 1 < count ? side + 1 : 0]; }
};

/// The same points, in the frame of the part.
Hull hull_of(RoundedPolygon const& part);

/// The hull with its origin at `place_mm`, and turned by the angle whose unit vector is `ahead`.
Hull placed(Hull const& hull, Vec2 place_mm, Vec2 ahead);

/// A straight line with ends.
struct Line {
    Vec2 from_mm;
    Vec2 to_mm;
};

inline Line side_of(Hull const& hull, std::uint32_t side) {
    return {hull.corner_mm[side], hull.next_corner_mm(side)};
}

float distance_mm2(Line const& line, Vec2 point_mm);

/// How high the lowest corner of a hull is above `from_mm`, in the direction of the unit vector `up`.
float lowest_mm(Hull const& hull, Vec2 from_mm, Vec2 up);

/// The side of a hull from which another one is furthest away. Without sides: minus infinity.
struct Furthest {
    float distance_mm = -std::numeric_limits<float>::max();  // between the polygons, without the rounding
    std::uint32_t side = 0;
};

/// The axis of least overlap: S. Gottschalk, "Separating axis theorem" (1996).
Furthest furthest_from_side(Hull const& of, Hull const& other);

/// The distance between two hulls, not both of which have a single corner; negative when they overlap: by how much at
/// least.
float gap_between_mm(Hull const& a, Hull const& b);

}  // namespace pogosim
