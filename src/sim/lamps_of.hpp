// From a checked configuration to the lamps of a run.
#pragma once

#include <vector>

#include "config/scenario.hpp"
#include "geometry/arena.hpp"

namespace pogosim {

/// The lamps of the configuration, in its order. Throws ConfigError for a disk, rectangle or triangle of light whose
/// centre is outside of the arena's bounding box.
std::vector<LampSpec> lamps_of(Scenario const& scenario, Arena const& arena);

/// What a lamp can light at time 0.
struct LampArea {
    Shape shape;
    Vec2 centre_mm;
};
LampArea area_at_start(LampSpec const& lamp);

}  // namespace pogosim
