/// @file
/// The five RGB LEDs. 0 to 255 per channel; on a real robot, values above about 25 are dazzling.
#ifndef POGOSIM_POGOLIB_LEDS_H
#define POGOSIM_POGOLIB_LEDS_H

/// A colour.
typedef struct {
    uint8_t r;  ///< red, 0 to 255
    uint8_t g;  ///< green
    uint8_t b;  ///< blue
} color_t;

#ifdef __cplusplus
extern "C" {
#endif
POGO_BEGIN_API

/// Colour of the head LED (0), 0 to 255 per channel. It stays until it is changed.
/// @range r, g, b: 0 to 255
void pogobot_led_setColor(uint8_t const r, uint8_t const g, uint8_t const b);

/// Colour of LED `id`: 0 head, 1 front, 2 right, 3 back, 4 left. Other values do nothing. On real robots, 1 to 4
/// require a board with five LEDs.
/// @range r, g, b: 0 to 255; id: 0 to 4
void pogobot_led_setColors(uint8_t const r, uint8_t const g, uint8_t const b, uint8_t id);

POGO_END_API
#ifdef __cplusplus
}
#endif

#endif
