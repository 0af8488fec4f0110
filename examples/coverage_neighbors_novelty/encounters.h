// The robots that a robot has met: the last 128 different ones, and the time of the first encounter.
#ifndef COVERAGE_ENCOUNTERS_H
#define COVERAGE_ENCOUNTERS_H

#include <stdbool.h>
#include <stdint.h>

#define MAX_ENCOUNTERS 128

typedef struct {
    uint16_t id;
    uint32_t first_met_ms;
} encounter_t;

typedef struct {
    uint8_t nb;
    uint8_t oldest;  // place in the ring that is written next when it is full
    encounter_t ring[MAX_ENCOUNTERS];
} encounters_t;

/// Remembers a robot that is met for the first time, in place of the one remembered longest when there is no room.
void encounters_meet(encounters_t* encounters, uint16_t id, uint32_t now_ms);

/// Whether this robot was first met longer ago than that.
bool encounters_is_old(encounters_t const* encounters, uint16_t id, uint32_t now_ms, uint32_t age_ms);

#endif
