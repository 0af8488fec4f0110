// Convex polygons with rounded corners, and where two of them touch.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "base/vec2.hpp"
#include "physics/wall_neighbour_list.hpp"

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

/// The hull with its origin at `place_mm`, and turned by the angle whose unit vector is `ahead`.
Hull placed(Hull const& hull, Vec2 place_mm, Vec2 ahead);

/// A point in which two hulls touch, or come near.
struct ManifoldPoint {
    Vec2 point_mm;               // in the middle of the gap
    float gap_mm = 0.0F;         // negative: they overlap by so much
    std::uint32_t features = 0;  // names the corners and sides that meet; the same from step to step
};

struct Manifold {
    Vec2 normal;  // unit vector from `b` to `a`
    std::array<ManifoldPoint, 2> touch{};
    std::uint32_t count = 0;
};

/// The touches of two hulls, not both of which are disks, with gaps of less than `reach_mm`: two where sides face each
/// other, otherwise one. The axis of least overlap: S. Gottschalk, "Separating axis theorem" (1996); sides are clipped
/// as in E. Catto, "Contact manifolds", Game Developers Conference 2007.
Manifold touches_of(Hull const& a, Hull const& b, float reach_mm);

/// The touches of a hull with an edge of a wall. A hull whose centre is behind the edge does not touch it: see gap_to.
Manifold touches_with(Hull const& hull, WallSide const& side, float reach_mm);

/// The distance between two hulls, not both of which are disks; negative when they overlap: by how much at least.
float gap_between_mm(Hull const& a, Hull const& b);

}  // namespace pogosim
