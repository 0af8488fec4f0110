// Invariants of all robots' controllers between two steps, checked in Debug builds only.
#pragma once

#include <span>

#include "robot/controller.hpp"
#include "world/world.hpp"

namespace pogosim {

#ifdef NDEBUG
inline void assert_controllers(World const& /*world*/, std::span<Controller const> /*controllers*/) {}
#else
/// Every robot has a controller; powers and biases are in their ranges, clocks do not stand before the start,
/// velocities that motors ask for are finite, and no mailbox holds more than it may.
void assert_controllers(World const& world, std::span<Controller const> controllers);
#endif

}  // namespace pogosim
