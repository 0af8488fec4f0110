// What the neighbours said during the current period: the latest values of each.
#ifndef SSR_NEIGHBORS_H
#define SSR_NEIGHBORS_H

#include <stdint.h>

#define MAX_NEIGHBORS 20
#define NB_DIFFUSIONS 3  // values in a message: as many diffusions run at the same time

typedef struct {
    uint16_t id;
    float val[NB_DIFFUSIONS];
} neighbor_t;

typedef struct {
    uint8_t nb;
    neighbor_t list[MAX_NEIGHBORS];
} neighbors_t;

/// Stores what a neighbour said, in place of what it said before. When the table is full, new neighbours are ignored.
void neighbors_hear(neighbors_t* neighbors, uint16_t id, float const* val);

void neighbors_forget(neighbors_t* neighbors);

/// Sum over the neighbours of (their value - own value).
float neighbors_sum_of_differences(neighbors_t const* neighbors, uint8_t diffusion, float own);

#endif
