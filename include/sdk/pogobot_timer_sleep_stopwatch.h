/// @file
/// Stopwatches and timers, which pogobot.h and pogobase.h declare.
#ifndef POGOSIM_SDK_TIMER_SLEEP_STOPWATCH_H
#define POGOSIM_SDK_TIMER_SLEEP_STOPWATCH_H

#include <stdbool.h>
#include <stdint.h>

#endif
