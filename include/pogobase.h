/// @file
/// The one header of a Pogobot program. The same source compiles for the simulator and, with -DREAL_ROBOT and the
/// Pogobot SDK, for the robots. C11, C17, C++17 and C++20; inside or outside an extern "C" block.
#ifndef POGOBASE_H
#define POGOBASE_H

#ifdef POGOSIM_FOR_SDK
#error "pogobot.h is included before pogobase.h: take one of them. pogobase.h has all that is in pogobot.h"
#endif

#include "pogosim/pogosim.h"
#include "pogosim/version.h"

#endif
