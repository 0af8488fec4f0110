// pogolib/leds.h
#include "robot/context.hpp"

using pogosim::context;

void pogobot_led_setColor(uint8_t const r, uint8_t const g, uint8_t const b) {
    pogobot_led_setColors(r, g, b, 0);
}

void pogobot_led_setColors(uint8_t const r, uint8_t const g, uint8_t const b, uint8_t id) {
    if (context.has_robot() && id < pogosim::kLedCount) {
        context.world->robots.led[context.robot][id] = {r, g, b};
    }
}
