// What stands at a fixed place before a formation comes: rigid bodies, and rings that objects may stand inside of.
#pragma once

#include <string>
#include <vector>

#include "geometry/arena.hpp"
#include "geometry/shape.hpp"

namespace pogosim {

/// All points within `half_thickness_mm` of a closed line; a solid one also has what the line encloses. It may stick
/// out of the arena.
struct Obstacle {
    std::string name;                // for messages
    Polygon line;                    // mm; without crossings; one corner is a point
    float half_thickness_mm = 0.0F;  // >= 0
    bool solid = true;
};

/// The parts of a rigid body.
std::vector<Obstacle> solid_obstacles(std::string const& name, Shape const& shape, Vec2 position_mm, float heading_rad);

/// The same obstacle elsewhere.
Obstacle moved_by(Vec2 offset_mm, Obstacle obstacle);

/// Copies of what reaches across the borders of a periodic box, where it comes in again on the other side.
std::vector<Obstacle> images_across(Box const& bounds_mm, Obstacle const& obstacle);

/// Distance from the point to the obstacle, mm; negative inside of it.
float gap_mm(Obstacle const& obstacle, Vec2 point_mm);

/// How deep two obstacles reach into each other, mm, by points spread along their lines; 0 when they are apart.
float overlap_mm(Obstacle const& a, Obstacle const& b);

/// How deep the obstacle reaches into the walls of the arena or beyond, mm; 0 when it stands inside.
float overlap_mm(Obstacle const& obstacle, Arena const& arena);

}  // namespace pogosim
