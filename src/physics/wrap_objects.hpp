// The seam of a periodic world.
#pragma once

#include <vector>

#include "physics/box2d_units.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Takes objects whose centre is out of the bounds to the other side, as a whole. What a soft membrane encloses goes
/// with the membrane and not before, so that the seam does not take it out of there; it may be out of the bounds
/// meanwhile, as parts of the membrane are. `bodies`: index as in World::bodies.
void wrap_objects(World const& world, std::vector<b2Body*> const& bodies);

}  // namespace pogosim
