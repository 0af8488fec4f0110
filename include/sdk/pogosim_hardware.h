// Marks functions of the robot's hardware that are not simulated. A program may include their headers, and call them
// between `#ifndef SIMULATOR` and `#endif`; elsewhere, a call does not compile. In firmware for the emulated processor
// (`make emu`), which is also compiled what is between the two, the call compiles, and ends the run if it is reached.
#ifndef POGOSIM_SDK_HARDWARE_H
#define POGOSIM_SDK_HARDWARE_H

#include <stddef.h>
#include <stdint.h>

#define POGO_NOT_SIMULATED                                                                                        \
    POGO_NOT_SIMULATED_BECAUSE(                                                                                   \
        "it is a part of the robot's hardware that is not simulated: put the call between #ifndef SIMULATOR and " \
        "#endif (docs/porting.md)")
#ifdef REAL_ROBOT
#define POGO_NOT_SIMULATED_BECAUSE(reason)
#elif defined(__clang__) || (defined(__GNUC__) && __GNUC__ >= 12)
#define POGO_NOT_SIMULATED_BECAUSE(reason) __attribute__((unavailable(reason)))
#else
#define POGO_NOT_SIMULATED_BECAUSE(reason) __attribute__((error(reason)))
#endif

#endif
