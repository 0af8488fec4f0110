// Where objects can stand in an arena: quick answers for many points.
#pragma once

#include <cstdint>
#include <vector>

#include "base/random.hpp"
#include "geometry/arena.hpp"

namespace pogosim {

/// The arena's edges sorted into horizontal bands, so that a question looks at the edges near its point only.
class FreeSpace {
public:
    explicit FreeSpace(Arena const& arena);

    /// True when the point is inside the arena and at least `clearance_mm` from every wall.
    bool holds(Vec2 point_mm, float clearance_mm) const;

    /// Moves a point that lacks clearance away from its nearest wall, again and again. The result holds the clearance
    /// unless the place is too narrow for it.
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

    void add_walls(Polygon const& polygon, bool is_hole);
    bool contains(Vec2 point) const;
    std::size_t band_of(float y) const;
    Wall const* nearest_wall_within(Vec2 point, float reach) const;

    Box bounds_;
    std::vector<Wall> walls_;
    std::vector<double> length_up_to_;               // of the walls, added up
    std::vector<std::vector<std::uint32_t>> bands_;  // walls that meet each band, from the top
};

}  // namespace pogosim
