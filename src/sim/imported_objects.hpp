// Checks of objects that the formation `imported` has placed.
#pragma once

#include <vector>

#include "config/scenario.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Whether the formation `imported` places the objects of an entry.
bool is_imported(Scenario const& scenario, ObjectConfig const& object);

/// Warns once about imported objects that overlap others, and once about those that reach into a wall: physics will
/// move them away from the places in the file. `poses` are those of each entry of the scenario; `world` has all of its
/// objects.
void warn_of_imported(Scenario const& scenario, World const& world, std::vector<std::vector<Placement>> const& poses);

}  // namespace pogosim
