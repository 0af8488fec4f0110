#include "neighbors.h"

void neighbors_hear(neighbors_t* neighbors, uint16_t id, uint32_t now_ms) {
    uint8_t place = 0;
    while (place < neighbors->nb && neighbors->list[place].id != id) {
        place++;
    }
    if (place == MAX_NEIGHBORS) {
        return;
    }
    if (place == neighbors->nb) {
        neighbors->nb++;
    }
    neighbors->list[place] = (neighbor_t){.id = id, .heard_ms = now_ms};
}

void neighbors_forget_old(neighbors_t* neighbors, uint32_t now_ms, uint32_t max_age_ms) {
    uint8_t place = 0;
    while (place < neighbors->nb) {
        if (now_ms - neighbors->list[place].heard_ms > max_age_ms) {
            neighbors->nb--;
            neighbors->list[place] = neighbors->list[neighbors->nb];
        } else {
            place++;
        }
    }
}
