#include "neighbors.h"

#include <string.h>

void neighbors_hear(neighbors_t* neighbors, uint16_t id, float const* val) {
    uint8_t place = 0;
    while (place < neighbors->nb && neighbors->list[place].id != id) {
        place++;
    }
    if (place == MAX_NEIGHBORS) {
        return;
    }
    if (place == neighbors->nb) {
        neighbors->list[place].id = id;
        neighbors->nb++;
    }
    memcpy(neighbors->list[place].val, val, sizeof(neighbors->list[place].val));
}

void neighbors_forget(neighbors_t* neighbors) {
    neighbors->nb = 0;
}

float neighbors_sum_of_differences(neighbors_t const* neighbors, uint8_t diffusion, float own) {
    float sum = 0.0f;
    for (uint8_t i = 0; i < neighbors->nb; i++) {
        sum += neighbors->list[i].val[diffusion] - own;
    }
    return sum;
}
