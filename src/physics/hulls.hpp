// The bodies that are not disks, fixed ones and movable ones: rectangles and triangles, which are convex.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/hull.hpp"
#include "world/world.hpp"

namespace pogosim {

class Hulls {
public:
    explicit Hulls(World const& world);

    bool empty() const { return hulls_.empty(); }
    bool is_one(std::uint32_t body) const { return !place_.empty() && place_[body] != kNone; }

    /// In the body's own frame. A disk is a hull with one corner.
    Hull of(World const& world, std::uint32_t body) const;

    /// Gap between a point and the hull of a body, whose pose is read from the world: negative inside, where the normal
    /// points out through the nearest side.
    Gap gap_to(World const& world, std::uint32_t body, Vec2 point_mm) const;

    /// The fraction of its motion after which a disk touches the hull of a fixed body; 1 if it never does, or touches
    /// it at the start.
    float fraction_to_touch(World const& world, std::uint32_t body, Vec2 from_mm, Vec2 motion_mm,
                            float radius_mm) const;

private:
    std::vector<Hull> hulls_;
    std::vector<std::uint32_t> place_;  // of each body in hulls_; kNone: it is a disk. Empty if all are
};

/// The convex polygon with these corners, clockwise on the screen.
Hull hull_of(Polygon const& corners_mm);

/// What a hull's density has to be multiplied by.
struct HullMass {
    float area_mm2;
    float gyration_mm2;  // moment of inertia about the origin, per mass
};
HullMass mass_of(Hull const& hull);

}  // namespace pogosim
