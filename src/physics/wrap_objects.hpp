// The seam of a periodic world.
#pragma once

#include <cstdint>
#include <vector>

#include "world/world.hpp"

namespace pogosim {

/// Takes objects whose centre is out of the bounds to the other side, as a whole. What a soft membrane encloses goes
/// with the membrane and not before, so that the seam does not take it out of there; it may be out of the bounds
/// meanwhile, as parts of the membrane are. Returns the bodies that were moved.
std::vector<std::uint32_t> wrap_objects(World& world);

}  // namespace pogosim
