/// @file
/// The header of the robots' SDK, for programs that were written for the robots alone: `main()` does not return, and
/// variables are globals. Compiled with this one, such a program runs in the simulator as it is; each simulated robot
/// has its own variables and its own `main()`, which may wait in the middle.
///
///     cc main.c -o prog $(PKG_CONFIG_PATH=build/release pkg-config --cflags --libs pogosim-sdk)
///
/// What belongs to the simulator alone (columns of the data file, values from the configuration) is in
/// pogosim/simulation.h, to be included between `#ifdef SIMULATOR` and `#endif`. Registers of the hardware are not
/// simulated.
#ifndef POGOBOT_H
#define POGOBOT_H

#ifndef POGOBASE_H
#include "pogosim_sdk_program.h"
#endif
#include "pogosim/pogolib.h"
#include "pogosim/shared_state.h"

#endif
