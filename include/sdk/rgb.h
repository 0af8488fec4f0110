/// @file
/// The robot's LEDs by the names of their driver.
#ifndef POGOSIM_SDK_RGB_H
#define POGOSIM_SDK_RGB_H

#include "pogosim_hardware.h"

#define rgb_init() ((void)0)
#define rgb_set(r, g, b) pogobot_led_setColor((r), (g), (b))
#define rgb_set_led(r, g, b, id) pogobot_led_setColors((r), (g), (b), (id))
/// Colours as 0xRRGGBB.
#define rgb_set_u32(word) rgb_set_hex((word), 0)
#define rgb_set_hex(word, id) \
    pogobot_led_setColors((uint8_t)((uint32_t)(word) >> 16), (uint8_t)((uint32_t)(word) >> 8), (uint8_t)(word), (id))

#ifdef __cplusplus
extern "C" {
#endif
void color_wheel(uint8_t position) POGO_NOT_SIMULATED_BECAUSE("it is not simulated: call rainbow_colormap()");
void rgb_blink_set_time(uint32_t time_on, uint32_t time_off) POGO_NOT_SIMULATED;
void rgb_blink_set_color(uint8_t r, uint8_t g, uint8_t b) POGO_NOT_SIMULATED;
void rgb_blink(void) POGO_NOT_SIMULATED;
void rgb_on_time(uint8_t ms) POGO_NOT_SIMULATED;
void rgb_off_time(uint8_t ms) POGO_NOT_SIMULATED;
void rgb_in_time(uint8_t ms) POGO_NOT_SIMULATED;
void rgb_out_time(uint8_t ms) POGO_NOT_SIMULATED;
void rgb_fixed(void) POGO_NOT_SIMULATED;
#ifdef __cplusplus
}
#endif

#endif
