// Speeds that the physics cannot follow.
#pragma once

#include "config/scenario.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Throws ConfigError when robots at full speed move or turn further in one step than the physics can follow, or
/// further than the world's membranes can hold back, naming the largest speed and the largest step that can be.
void check_motion(Scenario const& scenario, World const& world);

}  // namespace pogosim
