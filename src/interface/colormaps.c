// Colours for LEDs: the same code on simulated and real robots.
#include "pogosim/colormaps.h"

#include <stddef.h>

static void set_channel(uint8_t* channel, uint8_t value) {
    if (channel != NULL) {
        *channel = value;
    }
}

void qualitative_colormap(uint8_t const value, uint8_t* r, uint8_t* g, uint8_t* b) {
    static uint8_t const colors[10][3] = {{25, 0, 0},  {0, 25, 0},  {0, 0, 25},  {25, 25, 0}, {25, 0, 25},
                                          {0, 25, 25}, {13, 0, 13}, {13, 13, 0}, {0, 13, 13}, {10, 10, 10}};
    uint8_t const* color = colors[value % 10];
    set_channel(r, color[0]);
    set_channel(g, color[1]);
    set_channel(b, color[2]);
}

void rainbow_colormap(uint8_t const value, uint8_t* r, uint8_t* g, uint8_t* b) {
    // Along each of six segments one channel rises or falls by 25; 43 values a segment, 255 closes the circle.
    uint8_t const segment = (uint8_t)(value * 6 / 256);
    uint8_t const rise = (uint8_t)((value * 6 % 256) * 25 / 255);
    uint8_t const fall = (uint8_t)(25 - rise);
    uint8_t const colors[6][3] = {{25, rise, 0}, {fall, 25, 0}, {0, 25, rise},
                                  {0, fall, 25}, {rise, 0, 25}, {25, 0, fall}};
    set_channel(r, colors[segment][0]);
    set_channel(g, colors[segment][1]);
    set_channel(b, colors[segment][2]);
}

void hsv_to_rgb(float h_deg, float s, float v, uint8_t* r, uint8_t* g, uint8_t* b) {
    float const sixths = h_deg / 60.0f;
    int const sextant = sixths >= 0.0f && sixths < 5.0f ? (int)sixths : 5;
    float const along = sixths >= 0.0f && sixths < 6.0f ? sixths - (float)sextant : 1.0f;
    float const p = v * (1.0f - s);
    float const q = v * (1.0f - s * along);
    float const t = v * (1.0f - s * (1.0f - along));
    float const colors[6][3] = {{v, t, p}, {q, v, p}, {p, v, t}, {p, q, v}, {t, p, v}, {v, p, q}};
    set_channel(r, (uint8_t)(colors[sextant][0] * 255.0f));
    set_channel(g, (uint8_t)(colors[sextant][1] * 255.0f));
    set_channel(b, (uint8_t)(colors[sextant][2] * 255.0f));
}
