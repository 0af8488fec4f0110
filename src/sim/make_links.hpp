// The links of a configuration, between bodies that stand at their places.
#pragma once

#include "config/scenario.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Appends the links of the scenario to the world: entry after entry, those of an entry in the order of their objects.
/// Throws ConfigError.
void make_links(Scenario const& scenario, World& world);

}  // namespace pogosim
