/// @file
/// Sleeping: msleep(), usleep() and sleep() of the SDK, which pogobot.h and pogobase.h declare, too.
#ifndef POGOSIM_SDK_SLEEP_H
#define POGOSIM_SDK_SLEEP_H

#include "pogosim_hardware.h"

#ifdef __cplusplus
extern "C" {
#endif
void msleep(int milliseconds);
#ifdef __cplusplus
}
#endif

#endif
