#include "physics/position_correction.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/shape.hpp"

namespace pogosim {

namespace {

// A motion along walls ends at the third wall that it meets, or where two walls hold it in a corner.
constexpr int kMostWalls = 3;
// Walls are sought within this many radii.
constexpr float kLookRadii = 8.0F;
// Smallest radius of a body relative to the largest coordinate: half of it is well above the rounding of float.
constexpr float kSmallestRadius = 8e-6F;

}  // namespace

PositionCorrection::PositionCorrection(World const& world) : walls_(world.arena) {
    Box const& box = world.arena.bounds;
    float const smallest_mm = kSmallestRadius * std::max({std::abs(box.min.x), std::abs(box.min.y), std::abs(box.max.x),
                                                          std::abs(box.max.y)});
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        clearances_.push_back({.last_mm = world.bodies.position_mm[i],
                               .free_mm = 0.0F,
                               .radius_mm = std::max(inner_radius(world.bodies.shape[i]), smallest_mm)});
    }
}

Vec2 PositionCorrection::look_at_walls(Clearance& clearance, Vec2 place_mm, float sunk_share) const {
    float const least_mm = sunk_share * clearance.radius_mm;
    Vec2 const motion_mm = place_mm - clearance.last_mm;
    clearance.last_mm =
        walls_.first_touch(clearance.last_mm, motion_mm, least_mm) ? slide(clearance, motion_mm) : place_mm;
    clearance.free_mm =
        walls_.distance(clearance.last_mm, kLookRadii * clearance.radius_mm) - kSunkShare * clearance.radius_mm;
    return clearance.last_mm;
}

Vec2 PositionCorrection::slide(Clearance const& clearance, Vec2 motion_mm) const {
    Vec2 place_mm = clearance.last_mm;
    for (int wall = 0; wall < kMostWalls; ++wall) {
        std::optional<WallTouch> const touch = walls_.first_touch(place_mm, motion_mm, clearance.radius_mm);
        if (!touch) {
            place_mm = place_mm + motion_mm;
            break;
        }
        auto const fraction = static_cast<float>(touch->fraction);
        place_mm = place_mm + fraction * motion_mm;
        motion_mm = (1.0F - fraction) * motion_mm;
        motion_mm = motion_mm - dot(motion_mm, touch->normal) * touch->normal;
    }
    return place_mm;
}

}  // namespace pogosim
