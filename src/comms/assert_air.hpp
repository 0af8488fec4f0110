// What holds for everything on the air, checked in Debug builds only.
#pragma once

#include "world/world.hpp"

namespace pogosim {

#ifdef NDEBUG
inline void assert_air(World const& /*world*/) {}
#else
/// Senders exist, emitters, chances and ranges are possible, and payloads are where their messages say. Every robot has
/// a mailbox.
void assert_air(World const& world);
#endif

}  // namespace pogosim
