// A straight line y = a + b t through points, by ordinary least squares, one point at a time.
#ifndef SSR_LINE_FIT_H
#define SSR_LINE_FIT_H

#include <stdint.h>

// No list of points: means and sums of products of deviations from them are enough. Unlike sums of t^2 and t y they
// stay accurate in single precision (B. P. Welford, "Note on a method for calculating corrected sums of squares and
// products", Technometrics 4, 1962).
typedef struct {
    uint16_t nb_points;
    float mean_t;
    float mean_y;
    float sum_tt;  // of (t - mean_t)^2
    float sum_ty;  // of (t - mean_t) (y - mean_y)
} line_fit_t;

void line_fit_add(line_fit_t* fit, float t, float y);

/// b; 0 with fewer than two points.
float line_fit_slope(line_fit_t const* fit);

/// a + b t
float line_fit_at(line_fit_t const* fit, float t);

#endif
