// Where hulls touch each other and walls.
#pragma once

#include <array>
#include <cstdint>

#include "geometry/hull.hpp"
#include "physics/wall_side.hpp"

namespace pogosim {

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
/// other, otherwise one. Sides are clipped as in E. Catto, "Contact manifolds", Game Developers Conference 2007.
Manifold touches_of(Hull const& a, Hull const& b, float reach_mm);

/// The touches of a hull with an edge of a wall. A hull whose centre is behind the edge does not touch it: see gap_to.
Manifold touches_with(Hull const& hull, WallSide const& side, float reach_mm);

}  // namespace pogosim
