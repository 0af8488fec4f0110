/// @file
/// Pogolib for firmware that the simulator runs on an emulated processor (`make emu`): what pogobot.h of the robots'
/// SDK is for robots. The declarations are those of simulated programs; there is no code behind them, since the
/// simulator takes over at each call.
#ifndef POGOBOT_H
#define POGOBOT_H

#ifndef REAL_ROBOT
#error "this pogobot.h is for firmware: compile with -DREAL_ROBOT, as `make emu` does"
#endif

#include <inttypes.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define POGOLIB_RELEASE_VERSION "v2.7"

// As in pogosim/pogosim.h: on a robot, a global is the robot's own.
#define POGO_PER_ROBOT
#define POGO_BEGIN_API
#define POGO_END_API

#include "pogosim/pogolib/flash.h"
#include "pogosim/pogolib/helper.h"
#include "pogosim/pogolib/infrared.h"
#include "pogosim/pogolib/leds.h"
#include "pogosim/pogolib/magnetometer.h"
#include "pogosim/pogolib/motors.h"
#include "pogosim/pogolib/sensors.h"
#include "pogosim/pogolib/timers.h"

#endif
