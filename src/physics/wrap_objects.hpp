// The seam of a periodic world.
#pragma once

#include <cstdint>
#include <vector>

#include "world/world.hpp"

namespace pogosim {

/// Moves objects whose centre is out of bounds to the opposite side, as a whole. Bodies inside a soft membrane move
/// together with the membrane, so that the seam does not separate them; until then they may be out of bounds, as parts
/// of the membrane are. Returns the bodies that were moved.
std::vector<std::uint32_t> wrap_objects(World& world);

}  // namespace pogosim
