// A body in the copy on which the solvers of an island work, and what a push at a point of it does.
#pragma once

#include <cstdint>

#include "world/world.hpp"

namespace pogosim {

/// The mover that represents everything that is fixed. It stands in the origin, unturned.
inline constexpr std::uint32_t kStill = 0;

/// Neighbours in the arena are not neighbours in memory. Where bodies fill the caches, those that come next are
/// prefetched.
inline bool fills_caches(World const& world) {
    constexpr std::size_t kManyBodies = 10'000;
    return world.bodies.size() > kManyBodies;
}

struct Mover {
    Vec2 position_mm;
    Vec2 velocity_mm_s;
    float heading_rad = 0.0F;
    float angular_velocity_rad_s = 0.0F;
    float radius_mm = 0.0F;
    float inverse_mass = 0.0F;
    float inverse_inertia = 0.0F;
    std::uint32_t body = kNone;
    std::uint64_t blocks = 0;  // blocks with contacts of this body, see IslandSolver
    std::int32_t changed = 0;  // when a contact last changed its velocity, on the clock of the sub-step
};

/// Velocity of a point of a body that turns, relative to its centre.
inline Vec2 velocity_of(float spin_rad_s, Vec2 arm_mm) {
    return {-spin_rad_s * arm_mm.y, spin_rad_s * arm_mm.x};
}

/// Velocity of the end of an arm of `a` relative to that of an arm of `b`. Arms begin at the centre of each body.
inline Vec2 velocity_between(Mover const& a, Mover const& b, Vec2 arm_a_mm, Vec2 arm_b_mm) {
    return a.velocity_mm_s + velocity_of(a.angular_velocity_rad_s, arm_a_mm) - b.velocity_mm_s -
           velocity_of(b.angular_velocity_rad_s, arm_b_mm);
}

/// The inverse of the mass that a push along `way` at the ends of two arms has to move.
inline float inverse_mass(Mover const& a, Mover const& b, Vec2 arm_a_mm, Vec2 arm_b_mm, Vec2 way) {
    float const lever_a_mm = cross(arm_a_mm, way);
    float const lever_b_mm = cross(arm_b_mm, way);
    return a.inverse_mass + b.inverse_mass + a.inverse_inertia * lever_a_mm * lever_a_mm +
           b.inverse_inertia * lever_b_mm * lever_b_mm;
}

inline void push(Mover& mover, Vec2 arm_mm, Vec2 impulse) {
    mover.velocity_mm_s = mover.velocity_mm_s + mover.inverse_mass * impulse;
    mover.angular_velocity_rad_s += mover.inverse_inertia * cross(arm_mm, impulse);
}

}  // namespace pogosim
