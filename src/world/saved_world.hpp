// The state of a world as bytes, for a file: all that a run changes, not what its configuration determines.
#pragma once

#include "base/state_bytes.hpp"
#include "world/world.hpp"

namespace pogosim {

void append_world(World const& world, StateWriter& state);

/// Takes the bytes of append_world(). `world`: made by the same configuration. Throws ForeignState for another one; the
/// world is of no use then.
void take_world(World& world, StateReader& state);

}  // namespace pogosim
