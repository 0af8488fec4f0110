// Checks that involve several keys.
#pragma once

#include "config/scenario.hpp"

namespace pogosim {

/// Throws ConfigError, with the place of the key to change, for values that are valid alone but not together: more
/// steps, rows or frames than can be counted exactly; more objects than there are ids; files without a name; a frame
/// name without its one field; a formation whose root or file is missing. Warns when there is no robot.
void check_scenario(Scenario const& scenario);

}  // namespace pogosim
