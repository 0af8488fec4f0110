// What holds for bodies after each step, checked in Debug builds only.
#pragma once

#include "world/world.hpp"

namespace pogosim {

#ifdef NDEBUG
inline void assert_motion(Bodies const& /*bodies*/) {}
#else
/// Poses and velocities are finite, axes are unit vectors along the headings, and what is fixed stands still.
void assert_motion(Bodies const& bodies);
#endif

}  // namespace pogosim
