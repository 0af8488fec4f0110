// pogolib/leds.h
#include "robot/context.hpp"
#include "robot/require_robot.hpp"
#include "robot/slip.hpp"
#include "robot/waiting.hpp"

using pogosim::context;
using pogosim::require_robot;

void pogobot_led_setColor(uint8_t const r, uint8_t const g, uint8_t const b) {
    require_robot(__func__);
    pogobot_led_setColors(r, g, b, 0);
}

void pogobot_led_setColors(uint8_t const r, uint8_t const g, uint8_t const b, uint8_t id) {
    require_robot(__func__);
    pogosim::note_call();
    if (id >= pogosim::kLedCount) [[unlikely]] {
        pogosim::note_slip({__func__, "id", "0 (head) to 4 (left)", "nothing is set"}, id);
    } else if (context.has_robot()) {
        context.world->robots.led[context.robot][id] = {r, g, b};
    }
}
