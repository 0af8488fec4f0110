// pogobase.h for the simulator's own code: without the macros that rename main() and what prints for user programs, or
// that note which variables they read from the configuration.
#pragma once

#define POGOSIM_INSIDE
#include "pogobase.h"

#undef main
#undef printf
#undef putchar
#undef puts
#undef vprintf
