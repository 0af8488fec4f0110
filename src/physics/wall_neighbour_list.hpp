// The edges of walls that disks can touch in the coming steps: a Verlet list like that of neighbour_list.hpp.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "geometry/wall_index.hpp"
#include "physics/position_correction.hpp"
#include "world/world.hpp"

namespace pogosim {

struct NeighbourWall {
    std::uint32_t body;
    std::uint32_t edge;  // see WallNeighbourList::side()
};

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

class WallNeighbourList {
public:
    WallNeighbourList(World const& world, WallIndex const& walls);

    /// Finds the edges that are less than `skin_mm` from movable disks. `places`: those of the bodies now.
    void build(World const& world, PositionCorrection const& places, float skin_mm);

    std::span<NeighbourWall const> walls() const { return near_; }
    WallSide const& side(std::uint32_t edge) const { return (*sides_)[edge]; }

    /// All of them, which stay as they are.
    std::shared_ptr<WallSides const> const& sides() const { return sides_; }

private:
    std::shared_ptr<WallSides const> sides_;
    std::vector<NeighbourWall> near_;
    std::vector<std::uint32_t> found_;  // of one body
};

}  // namespace pogosim
