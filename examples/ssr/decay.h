// The rate lambda of an exponential decay s(t) = v exp(-lambda t), from values of s that arrive one by one.
//
// ln|s| = ln|v| - lambda t is a straight line. What is left of faster decays at the beginning, and noise at the end,
// bends it; so of all the lines fitted so far, the one that best fits the latest points counts.
#ifndef SSR_DECAY_H
#define SSR_DECAY_H

#include <stdbool.h>
#include <stdint.h>

#include "line_fit.h"

#define DECAY_WINDOW 40  // points that judge a line

typedef struct {
    line_fit_t line;                       // of ln|s| over t, through all points
    float squared_residual[DECAY_WINDOW];  // of the latest points, each from the line it was the last point of
    float lambda;                          // of the best line; until the window is full, of the latest
    float mean_squared_residual;           // of that line
} decay_t;

/// s must not be 0.
void decay_add(decay_t* decay, float t, float s);

/// Whether lambda rests on a full window and at least this many points, and they look like an exponential decay at all.
bool decay_is_known(decay_t const* decay, uint16_t min_nb_points);

#endif
