// Objects that stand before the formation comes: it keeps off them.
#pragma once

#include <vector>

#include "config/scenario.hpp"
#include "geometry/obstacle.hpp"
#include "world/world.hpp"

namespace pogosim {

/// One obstacle for each of these poses of a tangible entry: a rigid body is solid, a ring encloses free space.
std::vector<Obstacle> obstacles_of(ObjectConfig const& object, std::vector<Placement> const& poses);

/// Warns of entries with a fixed position whose objects reach deep into each other or into a wall, naming both.
void warn_of_overlaps(Scenario const& scenario, World const& world);

}  // namespace pogosim
