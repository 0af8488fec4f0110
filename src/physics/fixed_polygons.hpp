// Polygonal obstacles, and how disks touch them.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/wall_neighbour_list.hpp"
#include "world/world.hpp"

namespace pogosim {

/// The fixed bodies that are not disks: rectangles and triangles, which are convex. Their poses are read from the world
/// at each call.
class FixedPolygons {
public:
    explicit FixedPolygons(World const& world);

    bool is_one(std::uint32_t body) const { return !polygons_.empty() && polygons_[body].count > 0; }

    /// Gap between a point and a polygon: negative inside, where the normal points out through the nearest side.
    Gap gap_to(World const& world, std::uint32_t body, Vec2 point_mm) const;

    /// The fraction of its motion after which a disk touches a polygon; 1 if it never does, or touches it at the start.
    float fraction_to_touch(World const& world, std::uint32_t body, Vec2 from_mm, Vec2 motion_mm,
                            float radius_mm) const;

private:
    struct Side {
        Vec2 from_mm;  // in the body's frame
        Vec2 along;    // unit vector
        Vec2 outwards;
        float length_mm;
    };
    struct Polygon {
        std::uint32_t first = 0;  // into sides_
        std::uint32_t count = 0;  // 0: the body is a disk, or moves
    };

    std::vector<Side> sides_;
    std::vector<Polygon> polygons_;  // of each body; empty if there are none
};

}  // namespace pogosim
