// A compass made of the magnetometer: the ellipse that its readings describe as a robot turns, kept in flash.
//
// Iron in the robot adds a field of its own and distorts that of the Earth: readings lie on an ellipse away from the
// origin instead of a circle around it ("hard iron" and "soft iron"; M. J. Caruso, "Applications of magnetic sensors
// for low cost compass systems", IEEE Position, Location and Navigation Symposium, 2000). The fit is linear least
// squares: a conic
//
//     x^2 + y^2 = p0 (x^2 - y^2) + p1 2 x y + p2 x + p3 y + p4
//
// whose coefficients of x^2 and y^2 add up to 2 (F. L. Bookstein, "Fitting conic sections to scattered data", Computer
// Graphics and Image Processing 9, 1979, discusses such constraints). It matters neither where the origin is nor how
// the axes of the ellipse lie.
#ifndef COMPASS_H
#define COMPASS_H

#include <math.h>

#include "pogobase.h"

#define COMPASS_PI 3.14159265f
#define COMPASS_PAGE 0             // of the flash
#define COMPASS_MAGIC 0x31504D43u  // "CMP1": the page holds a compass
#define COMPASS_MAX_READINGS 640
#define COMPASS_MIN_READINGS 50
#define COMPASS_SCALE 128.0f  // counts; numbers near 1 keep sums of products exact enough

// Takes readings to the unit circle: symmetric matrix times (reading - centre).
typedef struct {
    float centre_x, centre_y;  // counts
    float xx, xy, yy;          // 1 / counts
    float major, minor;        // radii, counts
    float sense;               // 1 if readings go round the ellipse towards y as the robot turns clockwise, or else -1
} compass_t;

// Readings of a robot that turns clockwise (seen from above).
typedef struct {
    uint16_t count;
    int16_t x[COMPASS_MAX_READINGS], y[COMPASS_MAX_READINGS];
} compass_readings_t;

static inline void compass_add(compass_readings_t* readings, int16_t x, int16_t y) {
    if (readings->count < COMPASS_MAX_READINGS) {
        readings->x[readings->count] = x;
        readings->y[readings->count++] = y;
    }
}

// Solves five linear equations, the sixth column being the right side, by Gauss-Jordan elimination; the matrix is
// symmetric and positive, so pivots need no search. Returns false if they have no unique solution.
static inline bool compass_solve(float equations[5][6], float solution[5]) {
    for (int i = 0; i < 5; i++) {
        if (!(equations[i][i] > 1.0e-3f)) {
            return false;
        }
        for (int k = 0; k < 5; k++) {
            float const factor = k == i ? 0.0f : equations[k][i] / equations[i][i];
            for (int j = i; j < 6; j++) {
                equations[k][j] -= factor * equations[i][j];
            }
        }
    }
    for (int i = 0; i < 5; i++) {
        solution[i] = equations[i][5] / equations[i][i];
    }
    return true;
}

// Fits the ellipse. Returns false, and changes nothing, if the readings do not describe one: the robot has not turned.
static inline bool compass_fit(compass_readings_t const* readings, compass_t* compass) {
    if (readings->count < COMPASS_MIN_READINGS) {
        return false;
    }
    // With respect to the mean, which is inside the ellipse.
    int32_t sum_x = 0, sum_y = 0;
    for (uint16_t n = 0; n < readings->count; n++) {
        sum_x += readings->x[n];
        sum_y += readings->y[n];
    }
    float const mean_x = (float)sum_x / (float)readings->count, mean_y = (float)sum_y / (float)readings->count;

    float equations[5][6] = {{0.0f}};
    float area = 0.0f, last_u = 0.0f, last_v = 0.0f;  // swept by the readings: its sign is their sense
    for (uint16_t n = 0; n < readings->count; n++) {
        float const u = ((float)readings->x[n] - mean_x) / COMPASS_SCALE;
        float const v = ((float)readings->y[n] - mean_y) / COMPASS_SCALE;
        float const row[6] = {u * u - v * v, 2.0f * u * v, u, v, 1.0f, u * u + v * v};
        for (int i = 0; i < 5; i++) {
            for (int j = 0; j < 6; j++) {
                equations[i][j] += row[i] * row[j];
            }
        }
        area += last_u * v - u * last_v;
        last_u = u;
        last_v = v;
    }
    float p[5];
    if (!compass_solve(equations, p)) {
        return false;
    }

    // Matrix of the conic: ((1 - p0, -p1), (-p1, 1 + p0)), with eigenvalues 1 - s and 1 + s.
    float const s = sqrtf(p[0] * p[0] + p[1] * p[1]);
    float const determinant = 1.0f - s * s;
    if (s > 0.9f) {
        return false;
    }
    float const u = ((1.0f + p[0]) * p[2] + p[1] * p[3]) / (2.0f * determinant);
    float const v = (p[1] * p[2] + (1.0f - p[0]) * p[3]) / (2.0f * determinant);
    float const level = p[4] + (p[2] * u + p[3] * v) / 2.0f;
    if (!(level > 0.0f)) {
        return false;
    }
    // Square root of a symmetric 2 x 2 matrix of trace 2: (M + r I) / sqrt(2 + 2 r), where r^2 is its determinant.
    float const root = sqrtf(determinant);
    float const factor = 1.0f / (sqrtf((2.0f + 2.0f * root) * level) * COMPASS_SCALE);
    *compass = (compass_t){.centre_x = mean_x + u * COMPASS_SCALE,
                           .centre_y = mean_y + v * COMPASS_SCALE,
                           .xx = (1.0f - p[0] + root) * factor,
                           .xy = -p[1] * factor,
                           .yy = (1.0f + p[0] + root) * factor,
                           .major = sqrtf(level / (1.0f - s)) * COMPASS_SCALE,
                           .minor = sqrtf(level / (1.0f + s)) * COMPASS_SCALE,
                           .sense = area < 0.0f ? -1.0f : 1.0f};
    return true;
}

// Heading with respect to magnetic north, rad, -pi to pi, clockwise seen from above, as a reading says. On real robots
// it is off by the angle at which the sensor is mounted, the same for all.
static inline float compass_heading(compass_t const* compass, int16_t x, int16_t y) {
    float const u = (float)x - compass->centre_x, v = (float)y - compass->centre_y;
    return compass->sense * atan2f(compass->xy * u + compass->yy * v, compass->xx * u + compass->xy * v);
}

// ---- Flash ----

typedef struct {
    uint32_t magic;
    compass_t compass;
} compass_page_t;

static inline bool compass_load(compass_t* compass) {
    char page[POGOBOT_USER_FLASH_PAGE_SIZE];
    compass_page_t stored;
    read_page_flash(COMPASS_PAGE, page);
    memcpy(&stored, page, sizeof(stored));
    if (stored.magic != COMPASS_MAGIC) {
        return false;
    }
    *compass = stored.compass;
    return true;
}

// Erases all that the user's section of the flash holds: a page can be written once after each erasure.
static inline void compass_save(compass_t const* compass) {
    char page[POGOBOT_USER_FLASH_PAGE_SIZE];
    compass_page_t const stored = {.magic = COMPASS_MAGIC, .compass = *compass};
    memset(page, 0xFF, sizeof(page));
    memcpy(page, &stored, sizeof(stored));
    erase_write_section_flash();
    write_page_flash(COMPASS_PAGE, page);
}

#endif
