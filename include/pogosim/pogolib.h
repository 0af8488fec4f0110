/// @file
/// Pogolib for simulated robots: the functions of the Pogobot SDK, one header per part of the robot.
#ifndef POGOSIM_POGOLIB_H
#define POGOSIM_POGOLIB_H

#ifndef SIMULATOR
/// Defined in the simulator only: code for the simulator alone goes between `#ifdef SIMULATOR` and `#endif`.
#define SIMULATOR
#endif

#ifdef __cplusplus
extern "C++" {
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
}
#endif
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/// Version of the SDK that these functions follow.
#define POGOLIB_RELEASE_VERSION "v2.7"

// A variable that each robot has for itself: the simulator stores the value of the running robot in it.
// Thread-local, so that robots can run on several threads; the model makes each access a single instruction, in shared
// objects, too.
#ifdef __ELF__
#define POGO_PER_ROBOT __thread __attribute__((tls_model("initial-exec")))
#else
#define POGO_PER_ROBOT __thread
#endif
// Functions of the headers: messages name the line of the program that calls them.
#define POGO_INLINE inline __attribute__((always_inline, artificial))
#define POGO_BEGIN_API _Pragma("GCC visibility push(default)")
#define POGO_END_API _Pragma("GCC visibility pop")

// The real main() is the simulator's. It calls the program's main(), renamed robot_main, once for each robot, with one
// argument: the name of the program. Both `int main(void)` and `int main(int argc, char** argv)` are accepted.
#define main(...) \
    POGO_MAIN_PICK(__VA_ARGS__, POGO_MAIN_WITH_ARGUMENTS, POGO_MAIN_WITH_ARGUMENTS, robot_main, )(__VA_ARGS__)
#define POGO_MAIN_PICK(first, second, third, chosen, ...) chosen

#include "pogosim/pogolib/console.h"
#include "pogosim/pogolib/flash.h"
#include "pogosim/pogolib/formats.h"
#include "pogosim/pogolib/helper.h"
#include "pogosim/pogolib/infrared.h"
#include "pogosim/pogolib/leds.h"
#include "pogosim/pogolib/magnetometer.h"
#include "pogosim/pogolib/motors.h"
#include "pogosim/pogolib/sensors.h"
#include "pogosim/pogolib/timers.h"

#endif
