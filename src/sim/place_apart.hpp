// Categories with an area or a formation of their own.
#pragma once

#include <vector>

#include "base/random.hpp"
#include "config/scenario.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Places the objects of an entry whose `own_formation` is given: inside its area, where the arena has it, clear of the
/// obstacles. One pose for each. Throws ConfigError when they do not fit, or when the area is not in the arena.
std::vector<Placement> place_apart(Scenario const& scenario, World const& world, ObjectConfig const& object,
                                   std::vector<Obstacle> obstacles, RandomStream& random);

}  // namespace pogosim
