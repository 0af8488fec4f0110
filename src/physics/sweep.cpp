#include "physics/sweep.hpp"

#include <algorithm>
#include <cmath>

namespace pogosim {

namespace {

constexpr float kRoundingMm = 1.0F;  // of places far from the origin

/// The fraction of a relative motion after which two disks touch that do not at first; 1 if they never do. `way_mm`:
/// from one centre to the other.
float fraction_to_touch(Vec2 way_mm, Vec2 motion_mm, float radius_mm) {
    float const a = squared_length(motion_mm);
    float const b = dot(way_mm, motion_mm);
    float const c = squared_length(way_mm) - radius_mm * radius_mm;
    float const discriminant = b * b - a * c;
    if (c <= 0.0F || b >= 0.0F || discriminant < 0.0F) {
        return 1.0F;
    }
    return std::min(c / (-b + std::sqrt(discriminant)), 1.0F);
}

}  // namespace

void Sweep::stop_at_impacts(World& world, FixedPolygons const& polygons, std::span<Start const> fast, float dt_s) {
    Bodies& bodies = world.bodies;
    starts_mm_.resize(bodies.size());
    float fastest_mm_s = 0.0F;
    float largest_mm = 0.0F;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        starts_mm_[i] = bodies.position_mm[i] - dt_s * bodies.velocity_mm_s[i];
        fastest_mm_s = std::max(fastest_mm_s, length(bodies.velocity_mm_s[i]));
        largest_mm = std::max(largest_mm, bodies.radius_mm[i]);
    }
    for (Start const& start : fast) {
        starts_mm_[start.body] = start.position_mm;
    }
    float const farthest_mm = 2.0F * (fastest_mm_s * dt_s + largest_mm);
    grid_.build(starts_mm_, world.arena.bounds, farthest_mm, world.periodic);
    for (Start const& start : fast) {
        std::uint32_t const i = start.body;
        Vec2 const velocity_mm_s = bodies.velocity_mm_s[i];
        float const reach_mm =
            dt_s * (length(velocity_mm_s) + fastest_mm_s) + bodies.radius_mm[i] + largest_mm + kRoundingMm;
        float fraction = 1.0F;
        grid_.for_each_near(start.position_mm, reach_mm, [&](std::uint32_t k, Vec2 from_mm) {
            if (polygons.is_one(k)) {
                fraction = std::min(fraction, polygons.fraction_to_touch(world, k, start.position_mm,
                                                                         dt_s * velocity_mm_s, bodies.radius_mm[i]));
            } else if (k != i) {
                Vec2 const way = minimum_image(world, start.position_mm, from_mm);
                Vec2 const motion = dt_s * (bodies.velocity_mm_s[k] - velocity_mm_s);
                fraction =
                    std::min(fraction, fraction_to_touch(way, motion, bodies.radius_mm[i] + bodies.radius_mm[k]));
            }
        });
        if (fraction < 1.0F) {
            bodies.position_mm[i] = start.position_mm + fraction * dt_s * velocity_mm_s;
        }
    }
}

}  // namespace pogosim
