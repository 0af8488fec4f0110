// A copy of a run between two steps, from which it can go on again and again: Simulation::save() and restore().
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "brain/brain.hpp"
#include "light/lighting.hpp"
#include "physics/physics_engine.hpp"
#include "sim/link_changes.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Only the run that it is a copy of can go on from it, in the same process.
struct SavedState {
    World world;
    Lighting lighting;
    std::unique_ptr<PhysicsEngine> physics;
    BrokenLinks broken_links;
    std::vector<std::unique_ptr<SavedBrain>> brains;  // of Simulation::brains()
    bool stop_requested = false;                      // the program has asked for the end of the run
};

/// The memory that it takes, about.
std::size_t bytes_of(SavedState const& saved);

}  // namespace pogosim
