/// @file
/// Colours for LEDs, 0 to 25 per channel unless stated otherwise: higher values dazzle on the real robots.
/// A channel whose pointer is NULL is left out.
#ifndef POGOSIM_COLORMAPS_H
#define POGOSIM_COLORMAPS_H

#include <stdint.h>

/// From 0..255 of screens to 0..25 of LEDs, rounded. `x` is not checked.
/// @range x: 0 to 255; 0 to 25
#define SCALE_0_255_TO_0_25(x) (uint8_t)((x)*25.0f / 255.0f + 0.5f)
/// From 0..25 of LEDs to 0..250: ten times `x`, which is not checked.
/// @range x: 0 to 25; 0 to 250
#define SCALE_0_25_TO_0_255(x) (uint8_t)((x)*10)

#ifdef __cplusplus
extern "C" {
#endif
#if defined(__GNUC__) && !defined(REAL_ROBOT)
#pragma GCC visibility push(default)
#endif

/// One of ten colours that are easy to tell apart, chosen by `value` modulo 10. Channels 0 to 25.
/// @range value: 0 to 255; r, g, b: 0 to 25
void qualitative_colormap(uint8_t const value, uint8_t* r, uint8_t* g, uint8_t* b);

/// Red, yellow, green, cyan, blue, magenta and back to red as `value` goes from 0 to 255. Channels 0 to 25, never dark.
/// @range value: 0 to 255; r, g, b: 0 to 25
void rainbow_colormap(uint8_t const value, uint8_t* r, uint8_t* g, uint8_t* b);

/// Hue (degrees, 0 to 360; others are red), saturation and value (0 to 1, not checked) to channels of 0 to 255,
/// truncated to integers: scale them down for LEDs. Source: A. R. Smith, "Color gamut transform pairs", SIGGRAPH 1978.
/// @range h_deg: 0 to 360; s, v: 0 to 1; r, g, b: 0 to 255
void hsv_to_rgb(float h_deg, float s, float v, uint8_t* r, uint8_t* g, uint8_t* b);

#if defined(__GNUC__) && !defined(REAL_ROBOT)
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif
