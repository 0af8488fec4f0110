#include "line_fit.h"

void line_fit_add(line_fit_t* fit, float t, float y) {
    fit->nb_points++;
    float const dt = t - fit->mean_t;
    float const dy = y - fit->mean_y;
    fit->mean_t += dt / fit->nb_points;
    fit->mean_y += dy / fit->nb_points;
    fit->sum_tt += dt * (t - fit->mean_t);
    fit->sum_ty += dt * (y - fit->mean_y);
}

float line_fit_slope(line_fit_t const* fit) {
    return fit->sum_tt > 0.0f ? fit->sum_ty / fit->sum_tt : 0.0f;
}

float line_fit_at(line_fit_t const* fit, float t) {
    return fit->mean_y + line_fit_slope(fit) * (t - fit->mean_t);
}
