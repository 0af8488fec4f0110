// A number that stands for the state of a run.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "brain/brain.hpp"
#include "robot/controllers.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Two runs that are in the same state have the same hash, and practically no others: poses and velocities, LEDs,
/// light, links, messages on their way and in queues, clocks, motors, main loops and random streams of all robots. The
/// user data are not in it, as they may contain pointers; what differs in them shows in what robots do. FNV-1a, in
/// words of 64 bits, see G. Fowler, L. C. Noll and K.-P. Vo, "The FNV Non-Cryptographic Hash Algorithm", RFC 9923.
std::uint64_t state_hash(World const& world, Controllers const& controllers,
                         std::span<std::unique_ptr<Brain> const> brains);

}  // namespace pogosim
