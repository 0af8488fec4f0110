// Speeds that the physics cannot follow.
#pragma once

#include "config/scenario.hpp"
#include "physics/physics_engine.hpp"

namespace pogosim {

/// Throws ConfigError when robots at full speed move or turn further in one step than these limits, naming the largest
/// speed and the largest step that can be.
void check_motion(Scenario const& scenario, MotionLimits const& limits, double time_step_s);

}  // namespace pogosim
