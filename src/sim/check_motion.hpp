// Checks for speeds that the physics or the rows of the data file cannot follow.
#pragma once

#include "config/scenario.hpp"
#include "physics/physics_engine.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Throws ConfigError when robots at full speed move or turn further in one step than these limits, naming the largest
/// speed and the largest step that can be.
void check_motion(Scenario const& scenario, MotionLimits const& limits, double time_step_s);

/// Warns when robots are fast enough to cross half of a periodic arena between two rows of the data file: tools that
/// compute displacements from rows assume the shortest way.
void warn_of_ambiguous_rows(Scenario const& scenario, World const& world);

/// Warns when the arena is so large, or the step so short, that rounding positions changes speeds by one per cent.
void warn_of_rounded_speeds(Scenario const& scenario, World const& world);

}  // namespace pogosim
