#include "physics/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pogosim {

namespace {

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

void stop_at_impacts(World& world, std::span<Start const> fast, float dt_s) {
    Bodies& bodies = world.bodies;
    std::vector<Vec2> starts_mm(bodies.size());
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        starts_mm[i] = bodies.position_mm[i] - dt_s * bodies.velocity_mm_s[i];
    }
    for (Start const& start : fast) {
        starts_mm[start.body] = start.position_mm;
    }
    for (Start const& start : fast) {
        std::uint32_t const i = start.body;
        float fraction = 1.0F;
        for (std::uint32_t k = 0; k < bodies.size(); ++k) {
            if (k != i) {
                Vec2 const way = minimum_image(world, start.position_mm, starts_mm[k]);
                Vec2 const motion = dt_s * (bodies.velocity_mm_s[k] - bodies.velocity_mm_s[i]);
                fraction =
                    std::min(fraction, fraction_to_touch(way, motion, bodies.radius_mm[i] + bodies.radius_mm[k]));
            }
        }
        if (fraction < 1.0F) {
            bodies.position_mm[i] = start.position_mm + fraction * dt_s * bodies.velocity_mm_s[i];
        }
    }
}

}  // namespace pogosim
