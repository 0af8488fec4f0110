// From a checked configuration to a world at time 0.
#pragma once

#include <cstdint>

#include "config/scenario.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Builds the world: every object is in its place, and no user code has run. Throws ConfigError when the arena cannot
/// be read or the objects do not fit. `scenario` is as loaded.
World build_world(Scenario const& scenario, std::uint32_t seed);

/// Whether there are objects of this entry: not of lamps, nor of walls in a periodic arena, which has none.
bool is_created(ObjectConfig const& object, bool is_periodic);

/// Throws ConfigError if the arena cannot be read, or is too large.
void check_arena(Scenario const& scenario);

}  // namespace pogosim
