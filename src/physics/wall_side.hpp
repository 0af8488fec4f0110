// An edge of a wall as bodies touch it.
#pragma once

#include <optional>
#include <vector>

#include "base/vec2.hpp"
#include "geometry/wall_index.hpp"

namespace pogosim {

/// An edge of a wall as bodies touch it: from its free side, and at its first corner if that is convex.
struct WallSide {
    Vec2 from_mm;
    Vec2 along;   // unit vector to the other end
    Vec2 normal;  // unit vector into free space
    float length_mm;
    Vec2 along_previous;  // of the edge that ends at `from_mm`
    bool has_corner;      // convex: the free angle at `from_mm` is more than half a turn
    bool ends_in_corner;  // the same at the other end
};

/// Distance and direction from a thing to a point outside it.
struct Gap {
    float distance_mm;
    Vec2 normal;  // unit vector from the thing to the point
};

/// None if another edge or corner of the same wall is nearer, or if the point is behind the edge: a body whose centre
/// is on one side of a thin wall cannot touch its other side.
std::optional<Gap> gap_to(WallSide const& side, Vec2 point_mm);

/// Distance from the edge, from either side.
float distance_to(WallSide const& side, Vec2 point_mm);

using WallSides = std::vector<WallSide>;

/// Those of all edges, in their order.
WallSides sides_of(WallIndex const& walls);

}  // namespace pogosim
