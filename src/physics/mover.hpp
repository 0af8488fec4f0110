// A body in the copy on which the solvers of an island work.
#pragma once

#include <cstdint>

#include "world/world.hpp"

namespace pogosim {

/// The mover that represents everything that is fixed.
inline constexpr std::uint32_t kStill = 0;

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

}  // namespace pogosim
