// Where objects can stand in an arena: quick answers for many points.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/random.hpp"
#include "geometry/arena.hpp"
#include "geometry/formations/band_index.hpp"
#include "geometry/formations/obstacle_field.hpp"

namespace pogosim {

/// The inside of an arena, less what stands in it already.
class FreeSpace {
public:
    FreeSpace(Arena const& arena, std::span<Obstacle const> obstacles);

    /// True when the point is inside the arena and at least `clearance_mm` from every wall and obstacle.
    bool holds(Vec2 point_mm, float clearance_mm) const;

    /// The part of the arena's area that no obstacle covers, 0 to 1, give or take one in a hundred.
    double free_share() const;

    /// Moves a point that lacks clearance away from its nearest wall or obstacle, again and again. The result holds the
    /// clearance unless the place is too narrow for it.
    Vec2 pushed_inside(Vec2 point_mm, float clearance_mm) const;

    /// Uniform in the bounding box.
    Vec2 random_point(RandomStream& random) const;

    /// Uniform over the length of all walls, then `clearance_mm` away from it on the arena's side.
    Vec2 random_point_along_walls(float clearance_mm, RandomStream& random) const;

private:
    struct Wall {
        Vec2 from;
        Vec2 to;
        Vec2 inward;  // unit normal towards the arena
    };

    /// Where a cell of a grid over the bounds is, as a whole.
    enum class Side : std::uint8_t { kInside, kOutside, kUnknown };  // unknown: a wall comes near

    void add_walls(Polygon const& polygon, bool is_hole);
    void mark_cells_by(Wall const& wall);
    void find_sides();
    std::size_t cell_at(Vec2 point) const;
    Vec2 centre_of(std::size_t cell) const;
    bool contains(Vec2 point) const;
    bool is_enclosed(Vec2 point) const;
    Wall const* nearest_wall_within(Vec2 point, float reach) const;

    Box bounds_;
    Vec2 cells_per_mm_;   // of the grid
    double arena_share_;  // of the bounding box
    std::vector<Wall> walls_;
    std::vector<double> length_up_to_;  // of the walls, added up
    BandIndex bands_;                   // of walls
    std::vector<Side> sides_;           // of each cell, row by row
    ObstacleField obstacles_;
};

}  // namespace pogosim
