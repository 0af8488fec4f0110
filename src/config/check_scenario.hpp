// Checks that involve several keys.
#pragma once

#include "config/reading.hpp"
#include "config/scenario.hpp"

namespace pogosim {

/// Adds a mistake, with the place of the key to change, for values that are valid alone but not together: more
/// steps, rows or frames than can be counted exactly; more objects than there are ids; files without a name; a frame
/// name without its one field; a formation whose root or file is missing; old keys instead of robots. Warns when there
/// is no robot, or one does nothing. Objects are looked at only if all of them could be read (`objects_are_right`).
void check_scenario(Scenario const& scenario, bool objects_are_right, Reading& reading);

/// Throws KeyError if the objects of the scenario cannot be linked like that.
void check_link(Scenario const& scenario, LinkConfig const& link);

}  // namespace pogosim
