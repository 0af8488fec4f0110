// The motion of bodies in the last step, as an observer sees it. The velocities in Bodies are those with which the
// engine continues: a robot that its motors press against a wall has one, although it stands still.
#pragma once

#include <cstdint>

#include "world/world.hpp"

namespace pogosim {

inline BodyStep last_step(World const& world, std::uint32_t body) {
    Bodies const& bodies = world.bodies;
    return {.start_mm = bodies.start_mm[body],
            .end_mm = bodies.position_mm[body],
            .engine_mm_s = bodies.velocity_mm_s[body]};
}

Vec2 observed_velocity_mm_s(World const& world, BodyStep const& step);

struct ObservedMotion {
    Vec2 velocity_mm_s;
    float angular_velocity_rad_s = 0.0F;  // clockwise on the screen
};

/// Displacement and rotation of a body in the last step, divided by its duration. 0 before the first step, and for a
/// body that was moved by hand since the last one. In a periodic world, a body moves by less than half of it in a step.
ObservedMotion observed_motion(World const& world, std::uint32_t body);

/// The same of an object: of a membrane, the mean of its bodies, without rotation. 0 for one without a body.
ObservedMotion observed_motion(World const& world, Object const& object);

}  // namespace pogosim
