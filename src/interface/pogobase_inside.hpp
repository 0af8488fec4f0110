// pogobase.h for the simulator's own code: without the macros that rename main() and what prints for user programs.
#pragma once

#include "pogobase.h"

#undef main
#undef printf
#undef putchar
#undef puts
#undef vprintf
