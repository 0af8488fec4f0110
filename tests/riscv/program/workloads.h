// The workloads of program/workloads.c, which tests and bench/emulation run on emulators and on this machine.
#pragma once
#include <stdint.h>

enum { kCrc, kSort, kFloats, kMixture };

#ifdef __cplusplus
extern "C" {
#endif

// Does one of them, of a length, and returns a number that depends on each step.
uint32_t workload(uint32_t which, uint32_t count);

#ifdef __cplusplus
}
#endif
