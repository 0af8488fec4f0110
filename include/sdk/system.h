/// @file
/// Processor caches and waiting, by the names of the robot's basic software.
#ifndef POGOSIM_SDK_SYSTEM_H
#define POGOSIM_SDK_SYSTEM_H

#include "pogosim_hardware.h"

#define flush_cpu_icache() ((void)0)
#define flush_cpu_dcache() ((void)0)
#define flush_l2_cache() ((void)0)
#define busy_wait(milliseconds) msleep((int)(milliseconds))
#define busy_wait_us(microseconds) ((void)usleep((unsigned)(microseconds)))

#ifdef __cplusplus
extern "C" {
#endif
void reboot(void) POGO_NOT_SIMULATED_BECAUSE(
    "a robot restarts by the command DEADBEEF of the remote control, see is_muted() in pogobot.h");
#ifdef __cplusplus
}
#endif

#endif
