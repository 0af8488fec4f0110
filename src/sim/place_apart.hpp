// Categories with their own area or formation.
#pragma once

#include <vector>

#include "base/random.hpp"
#include "config/scenario.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Places the objects of an entry that has an `own_formation`: inside the part of its area that is in the arena, clear
/// of the obstacles. One pose per object. Throws ConfigError if they do not fit, or if the area is outside the arena.
std::vector<Placement> place_apart(Scenario const& scenario, World const& world, ObjectConfig const& object,
                                   std::vector<Obstacle> obstacles, RandomStream& random);

}  // namespace pogosim
