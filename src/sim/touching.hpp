// Finds what an object touches.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/physics_engine.hpp"
#include "world/world.hpp"

namespace pogosim {

struct Touched {
    bool wall = false;                   // of the arena
    std::vector<std::uint32_t> objects;  // indices into World::objects, ascending
};

/// Walls and objects no further away than motors make a body bounce. `gaps`: those of the engine that moves them.
Touched touched_by(World const& world, Object const& object, TouchGaps const& gaps);

}  // namespace pogosim
