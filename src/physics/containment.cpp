#include "physics/containment.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/shape.hpp"

namespace pogosim {

namespace {

// A motion along walls ends at the third wall that it meets, or where two walls hold it in a corner.
constexpr int kMostWalls = 3;
// Walls further away than this many radii are not looked for.
constexpr float kLookRadii = 8.0F;
// Of a body, in parts of the largest coordinate: half of it is well above the rounding of float.
constexpr float kSmallestRadius = 8e-6F;

}  // namespace

Containment::Containment(World const& world) : walls_(world.arena) {
    Box const& box = world.arena.bounds;
    float const smallest_mm = kSmallestRadius * std::max({std::abs(box.min.x), std::abs(box.min.y), std::abs(box.max.x),
                                                          std::abs(box.max.y)});
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        leashes_.push_back({.last_mm = world.bodies.position_mm[i],
                            .free_mm = 0.0F,
                            .radius_mm = std::max(inner_radius(world.bodies.shape[i]), smallest_mm)});
    }
}

Vec2 Containment::look_at_walls(Leash& leash, Vec2 place_mm, float sunk_share) const {
    float const least_mm = sunk_share * leash.radius_mm;
    Vec2 const motion_mm = place_mm - leash.last_mm;
    leash.last_mm = walls_.first_touch(leash.last_mm, motion_mm, least_mm) ? slide(leash, motion_mm) : place_mm;
    leash.free_mm = walls_.distance(leash.last_mm, kLookRadii * leash.radius_mm) - kSunkShare * leash.radius_mm;
    return leash.last_mm;
}

Vec2 Containment::slide(Leash const& leash, Vec2 motion_mm) const {
    Vec2 place_mm = leash.last_mm;
    for (int wall = 0; wall < kMostWalls; ++wall) {
        std::optional<WallTouch> const touch = walls_.first_touch(place_mm, motion_mm, leash.radius_mm);
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
