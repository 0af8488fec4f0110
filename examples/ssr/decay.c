#include "decay.h"

#include <math.h>

#define MAX_MEAN_SQUARED_RESIDUAL 100.0f

static float mean(float const* values, uint16_t nb) {
    float sum = 0.0f;
    for (uint16_t i = 0; i < nb; i++) {
        sum += values[i];
    }
    return sum / nb;
}

void decay_add(decay_t* decay, float t, float s) {
    float const y = logf(fabsf(s));
    line_fit_add(&decay->line, t, y);
    uint16_t const nb = decay->line.nb_points;

    float const residual = y - line_fit_at(&decay->line, t);
    decay->squared_residual[(nb - 1) % DECAY_WINDOW] = residual * residual;
    float const latest = mean(decay->squared_residual, nb < DECAY_WINDOW ? nb : DECAY_WINDOW);
    if (nb <= DECAY_WINDOW || latest < decay->mean_squared_residual) {
        decay->mean_squared_residual = latest;
        decay->lambda = -line_fit_slope(&decay->line);
    }
}

bool decay_is_known(decay_t const* decay, uint16_t min_nb_points) {
    uint16_t const nb = decay->line.nb_points;
    return nb >= DECAY_WINDOW && nb >= min_nb_points && decay->mean_squared_residual < MAX_MEAN_SQUARED_RESIDUAL;
}
