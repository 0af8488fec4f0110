// How long a run takes: a random duration, by one of three laws.
#ifndef COVERAGE_RUN_LAW_H
#define COVERAGE_RUN_LAW_H

#include <stdbool.h>
#include <stdint.h>

typedef enum {
    RUN_LEVY,         // Pareto: P(longer than t) = (min / t)^alpha; few long runs cover most of the distance
    RUN_EXPONENTIAL,  // of mean min
    RUN_LINEAR,       // uniform between min and max
} run_law_t;

/// False when there is no law of this name: levy, exponential, linear.
bool run_law_of_name(char const* name, run_law_t* law);

/// Duration (ms) between min and max.
uint32_t random_run_duration(run_law_t law, uint32_t min_ms, uint32_t max_ms, float alpha);

/// Uniform in ]0, 1], in steps of 1/65536.
float random_unit(void);

#endif
