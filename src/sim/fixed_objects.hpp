// Objects with fixed positions, which the formation avoids.
#pragma once

#include <vector>

#include "config/scenario.hpp"
#include "geometry/obstacle.hpp"
#include "world/world.hpp"

namespace pogosim {

/// One obstacle for each of these poses of a tangible entry: a rigid body is solid, a membrane encloses free space.
std::vector<Obstacle> obstacles_of(ObjectConfig const& object, std::vector<Placement> const& poses);

/// Warns about entries with a fixed position whose objects overlap each other or a wall deeply, naming both.
void warn_of_overlaps(Scenario const& scenario, World const& world);

}  // namespace pogosim
