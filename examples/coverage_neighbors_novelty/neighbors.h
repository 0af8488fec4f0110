// The robots nearby: those heard during the last moments.
#ifndef COVERAGE_NEIGHBORS_H
#define COVERAGE_NEIGHBORS_H

#include <stdint.h>

#define MAX_NEIGHBORS 20

typedef struct {
    uint16_t id;
    uint32_t heard_ms;  // last time
} neighbor_t;

typedef struct {
    uint8_t nb;
    neighbor_t list[MAX_NEIGHBORS];
} neighbors_t;

/// When the table is full, new neighbours are ignored.
void neighbors_hear(neighbors_t* neighbors, uint16_t id, uint32_t now_ms);

/// Takes out those not heard for longer than max_age_ms.
void neighbors_forget_old(neighbors_t* neighbors, uint32_t now_ms, uint32_t max_age_ms);

#endif
