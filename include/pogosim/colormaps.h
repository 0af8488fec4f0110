// Colours for LEDs, 0 to 25 per channel where not said otherwise: more is dazzling on the real robots.
#ifndef POGOSIM_COLORMAPS_H
#define POGOSIM_COLORMAPS_H

#include <stdint.h>

/// Between the LED range 0..25 and the 0..255 of screens.
#define SCALE_0_255_TO_0_25(x) (uint8_t)((x)*25.0f / 255.0f + 0.5f)
#define SCALE_0_25_TO_0_255(x) (uint8_t)((x)*10)

#ifdef __cplusplus
extern "C" {
#endif
#if defined(__GNUC__) && !defined(REAL_ROBOT)
#pragma GCC visibility push(default)
#endif

/// One of ten colours that are easy to tell apart: value modulo 10.
void qualitative_colormap(uint8_t const value, uint8_t* r, uint8_t* g, uint8_t* b);

/// Red, yellow, green, cyan, blue, magenta and back to red as the value goes from 0 to 255. Never dark.
void rainbow_colormap(uint8_t const value, uint8_t* r, uint8_t* g, uint8_t* b);

/// Hue (degrees, 0 to 360), saturation and value (0 to 1) to red, green and blue of 0 to 255 (A. R. Smith, "Color gamut
/// transform pairs", SIGGRAPH 1978).
void hsv_to_rgb(float h_deg, float s, float v, uint8_t* r, uint8_t* g, uint8_t* b);

#if defined(__GNUC__) && !defined(REAL_ROBOT)
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif
