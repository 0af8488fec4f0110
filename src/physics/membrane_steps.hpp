// Limits of motions and of spring frequencies in a sub-step, within which soft membranes hold bodies back.
#pragma once

#include <algorithm>

#include "geometry/shape.hpp"
#include "world/world.hpp"

namespace pogosim {

/// The joints of a membrane yield to bodies that hit it hard. It holds those that move by up to this share of half its
/// thickness per sub-step (found by trial with robots of 5 to 40 mm), or as far as in the sub-steps of slow robots.
inline constexpr float kMembraneShare = 0.2F;
inline constexpr float kLeastMembraneMotionMm = 0.5F;
/// Highest frequency of a spring, in oscillations per step. A stiffer spring cannot be integrated and would shake; its
/// frequency is reduced to this one.
inline constexpr float kMostSwingsPerStep = 0.5F;
/// Largest number of sub-steps, for the highest speeds.
inline constexpr int kMostSubsteps = 100;

/// Largest motion of a body in a sub-step with the membranes of this world; `without_mm` if there are none.
inline float most_motion_mm(World const& world, float without_mm) {
    float most_mm = without_mm;
    for (Membrane const& membrane : world.membranes) {
        float const half_thickness_mm = inner_radius(world.bodies.shape[membrane.body]);
        most_mm = std::min(most_mm, std::max(kMembraneShare * half_thickness_mm, kLeastMembraneMotionMm));
    }
    return most_mm;
}

}  // namespace pogosim
