// Invariants of the transmissions of a step, checked in Debug builds only.
#pragma once

#include "world/world.hpp"

namespace pogosim {

#ifdef NDEBUG
inline void assert_air(World const& /*world*/) {}
#else
/// Senders exist; emitters, probabilities and ranges are valid; payloads lie where their transmissions say. Every robot
/// has a mailbox.
void assert_air(World const& world);
#endif

}  // namespace pogosim
