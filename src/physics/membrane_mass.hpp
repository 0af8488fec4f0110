// Masses of the bodies of soft membranes in the engines.
#pragma once

#include <vector>

#include "world/world.hpp"

namespace pogosim {

/// Mass scaling: a solver cannot hold back a heavy body by a chain of light ones, so the bodies of membranes get more
/// mass if a robot with wheels has more than 30 times theirs. `mass`: of each body, in any unit.
void add_mass_to_membranes(World const& world, std::vector<float>& mass);

}  // namespace pogosim
