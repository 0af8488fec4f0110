// Objects with fixed positions, which the formation avoids.
#pragma once

#include "config/scenario.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Warns about entries with a fixed position whose objects overlap each other or a wall deeply, naming both.
void warn_of_overlaps(Scenario const& scenario, World const& world);

}  // namespace pogosim
