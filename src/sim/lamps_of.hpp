// From a checked configuration to the lamps of a run.
#pragma once

#include <vector>

#include "config/scenario.hpp"
#include "world/world.hpp"

namespace pogosim {

/// The lamps of the configuration, in its order. Uses only the arena and the cells of the light map. Warns of lamps
/// that light nothing: their centre is outside the arena's bounding box, or they lie between the centres of cells.
std::vector<LampSpec> lamps_of(Scenario const& scenario, World const& world);

/// The same lamps as objects of the world.
std::vector<PlacedLamp> placed_lamps(Scenario const& scenario, Arena const& arena);

/// The area that a lamp can light at time 0.
struct LampArea {
    Shape shape;
    Vec2 centre_mm;
};
LampArea area_at_start(LampSpec const& lamp);

}  // namespace pogosim
