// The second file of the C program.
#include "cases.h"

static float gain = 2.0f;  // found: gain 4
static float same_name = 1.0f;
uint32_t count_of_both_files = 1;  // found: count_of_both_files 4

void read_elsewhere(void) {
    init_from_configuration(limits_of_both_files.high);
    init_from_configuration(same_name);
}

uint32_t count_elsewhere(void) {
    gain += same_name;
    return ++count_of_both_files + count_in_header() + (gain > 3.0f ? 1 : 0);
}
