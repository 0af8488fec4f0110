// Speeds that the physics cannot follow.
#pragma once

#include "config/scenario.hpp"

namespace pogosim {

/// Throws ConfigError when robots at full speed move or turn further in one step of `time_step_s` than the physics can
/// follow, naming the largest speed and the largest step that it can.
void check_motion(Scenario const& scenario, double time_step_s);

}  // namespace pogosim
