// Invariants of every world, checked in Debug builds only.
#pragma once

#include "world/world.hpp"

namespace pogosim {

#ifdef NDEBUG
inline void assert_structure(World const& /*world*/) {}
#else
/// Arrays of the same things have the same sizes, and indices are valid. Poses are not checked.
void assert_structure(World const& world);
#endif

}  // namespace pogosim
