// Robots that are switched off, and on again.
#pragma once

#include <cstdint>

#include "world/world.hpp"

namespace pogosim {

/// Switches a robot off or on. While it is off, its clock is never due, its motors hold its body, and its LEDs are
/// dark. Switched on, it continues at its own time or now, whichever is later. Does nothing if it is in that state
/// already.
void set_alive(World& world, std::uint32_t robot, bool alive);

/// What a robot that is switched off goes on with; null: it is on.
SwitchedOff* find_switched_off(World& world, std::uint32_t robot);

/// Clock of a robot between two of its ticks, us; of one that is switched off, when that happened.
std::int64_t clock_us(World const& world, std::uint32_t robot);

/// For a callback, a robot that is switched off is as it was before: wake(), then rest().
void wake(World& world, SwitchedOff const& self);
void rest(World& world, SwitchedOff& self);

/// Commands rest to all of them, as motors without power do, but without their noise.
void hold_switched_off(World& world);

}  // namespace pogosim
