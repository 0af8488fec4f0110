// Shared by the two files of the C program. What pogosim-shared-state is to find is marked "found" with name and bytes.
#ifndef CASES_H
#define CASES_H

#include "pogobase.h"

typedef struct {
    uint32_t steps;
} USERDATA;
DECLARE_USERDATA(USERDATA)

typedef struct {
    float low;
    float high;
} limits_t;

extern limits_t limits_of_both_files;
extern uint32_t count_of_both_files;

static uint32_t counter_in_header;  // found: counter_in_header 4

static inline uint32_t count_in_header(void) {
    static uint16_t calls_in_header;  // found: calls_in_header 2
    return ++counter_in_header + ++calls_in_header;
}

uint32_t count_elsewhere(void);
void read_elsewhere(void);

#endif
