// pogolib/leds.h, and what colormaps.h does not check
#include "device/leds.hpp"
#include "robot/call_checks.hpp"
#include "robot/context.hpp"
#include "robot/waiting.hpp"

using pogosim::context;
using pogosim::note_slip;
using pogosim::NoteSlip;
using pogosim::require_robot;

// hsv_to_rgb() of colormaps.c, which is renamed where the simulator compiles it (src/CMakeLists.txt).
extern "C" void pogosim_hsv_to_rgb(float h_deg, float s, float v, uint8_t* r, uint8_t* g, uint8_t* b);

void hsv_to_rgb(float h_deg, float s, float v, uint8_t* r, uint8_t* g, uint8_t* b) {
    constexpr float full_circle_deg = 360.0F;
    constexpr auto wraps = "channels beyond 0 to 255 wrap around";
    auto const is_from_0_to = [](float most, float value) { return value >= 0.0F && value <= most; };
    if (!is_from_0_to(full_circle_deg, h_deg)) [[unlikely]] {
        note_slip({__func__, "h_deg", "0 to 360", "it counts as red"}, h_deg);
    }
    if (!is_from_0_to(1.0F, s)) [[unlikely]] {
        note_slip({__func__, "s", "0 to 1", wraps}, s);
    }
    if (!is_from_0_to(1.0F, v)) [[unlikely]] {
        note_slip({__func__, "v", "0 to 1", wraps}, v);
    }
    pogosim_hsv_to_rgb(h_deg, s, v, r, g, b);
}

void pogobot_led_setColor(uint8_t const r, uint8_t const g, uint8_t const b) {
    require_robot(__func__);
    pogobot_led_setColors(r, g, b, 0);
}

void pogobot_led_setColors(uint8_t const r, uint8_t const g, uint8_t const b, uint8_t id) {
    require_robot(__func__);
    pogosim::note_call();
    if (pogosim::is_led(pogosim::own_model(), id, NoteSlip{__func__}) && context.has_robot()) {
        pogosim::set_led(*context.world, context.robot, id, {r, g, b});
    }
}
