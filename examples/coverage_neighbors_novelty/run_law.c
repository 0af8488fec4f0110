#include "run_law.h"

#include "pogobase.h"  // rand() of this robot

#include <math.h>

float random_unit(void) {
    return ((float)(rand() & 0xffff) + 1.0f) / 65536.0f;
}

bool run_law_of_name(char const* name, run_law_t* law) {
    static char const* const names[] = {
        [RUN_LEVY] = "levy", [RUN_EXPONENTIAL] = "exponential", [RUN_LINEAR] = "linear"};
    for (unsigned i = 0; i < sizeof(names) / sizeof(names[0]); i++) {
        if (strcmp(name, names[i]) == 0) {
            *law = (run_law_t)i;
            return true;
        }
    }
    return false;
}

uint32_t random_run_duration(run_law_t law, uint32_t min_ms, uint32_t max_ms, float alpha) {
    float const u = random_unit();
    float const low = (float)min_ms;
    float const high = (float)max_ms;
    float duration = low;
    switch (law) {
        case RUN_LEVY:
            duration = low * powf(u, -1.0f / alpha);
            break;
        case RUN_EXPONENTIAL:
            duration = -low * logf(u);
            break;
        case RUN_LINEAR:
            duration = low + u * (high - low);
            break;
    }
    if (!(duration < high)) {
        return max_ms;
    }
    return duration < low ? min_ms : (uint32_t)duration;
}
