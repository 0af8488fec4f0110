// Makes an arrangement legal: pushes objects apart and off the walls.
#pragma once

#include <span>
#include <vector>

#include "geometry/formations/task.hpp"

namespace pogosim {

/// Moves the objects as little as it finds enough: first pairs that overlap apart and objects too near to a wall away
/// from it, again and again (position-based dynamics, M. Mueller et al., J. Vis. Commun. Image R. 18, 2007); then those
/// that are still caught, one by one, to a free one of the `spare_places`. Returns true when every object stands with
/// its clearance; false after a bounded number of rounds.
bool separate(PlacementTask const& task, std::vector<Vec2>& places_mm, std::span<Vec2 const> spare_places_mm);

}  // namespace pogosim
