// What the bodies of a soft membrane weigh in the engines.
#pragma once

#include <vector>

#include "world/world.hpp"

namespace pogosim {

/// Mass scaling: a solver cannot hold back a heavy body by a chain of light ones, so those of membranes get more mass
/// where a robot with wheels weighs more than 30 times as much. `mass`: of each body, in any unit.
void add_mass_to_membranes(World const& world, std::vector<float>& mass);

}  // namespace pogosim
