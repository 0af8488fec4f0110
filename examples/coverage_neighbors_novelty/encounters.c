#include "encounters.h"

#include <stddef.h>

static encounter_t const* find(encounters_t const* encounters, uint16_t id) {
    for (uint8_t i = 0; i < encounters->nb; i++) {
        if (encounters->ring[i].id == id) {
            return &encounters->ring[i];
        }
    }
    return NULL;
}

void encounters_meet(encounters_t* encounters, uint16_t id, uint32_t now_ms) {
    if (find(encounters, id) != NULL) {
        return;
    }
    encounter_t const met = {.id = id, .first_met_ms = now_ms};
    if (encounters->nb < MAX_ENCOUNTERS) {
        encounters->ring[encounters->nb++] = met;
    } else {
        encounters->ring[encounters->oldest] = met;
        encounters->oldest = (encounters->oldest + 1) % MAX_ENCOUNTERS;
    }
}

bool encounters_is_old(encounters_t const* encounters, uint16_t id, uint32_t now_ms, uint32_t age_ms) {
    encounter_t const* const met = find(encounters, id);
    return met != NULL && now_ms - met->first_met_ms > age_ms;
}
