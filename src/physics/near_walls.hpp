// Which edges of the walls disks can touch in the steps to come; as near_pairs.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/wall_index.hpp"
#include "world/world.hpp"

namespace pogosim {

struct NearWall {
    std::uint32_t body;
    std::uint32_t edge;  // into NearWalls::edges()
};

/// An edge of a wall as bodies meet it: from its free side, and at its first corner if that sticks out.
struct WallSide {
    Vec2 from_mm;
    Vec2 along;   // unit vector to the other end
    Vec2 normal;  // unit vector into free space
    float length_mm;
    Vec2 along_previous;  // of the edge that ends at `from_mm`
    bool has_corner;      // free space turns around `from_mm` by more than half a turn
};

/// What a thing is to a point outside of it.
struct Gap {
    float distance_mm;
    Vec2 normal;  // unit vector from the thing to the point
};

/// Nothing if another edge or corner of the same wall is nearer, or if the point is behind it: a body whose centre is
/// on one side of a thin wall has nothing to do with its other side.
std::optional<Gap> gap_to(WallSide const& side, Vec2 point_mm);

class NearWalls {
public:
    NearWalls(World const& world, WallIndex const& walls);

    /// Looks for the edges that are less than `skin_mm` from disks that are not fixed.
    void build(World const& world, WallIndex const& walls, float skin_mm);

    std::span<NearWall const> walls() const { return near_; }
    WallSide const& side(std::uint32_t edge) const { return sides_[edge]; }

private:
    std::vector<WallSide> sides_;
    std::vector<NearWall> near_;
    std::vector<std::uint32_t> found_;  // of one body
};

}  // namespace pogosim
