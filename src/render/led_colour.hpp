// How LEDs look on a screen.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "render/palette.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Brightness on the screen, 0 to 255, by the value of one colour of an LED. LEDs are bright at low values already: 0
/// is dark, from palette::kDimmestLed to kBrightestLed it goes up in a straight line, and more does not look brighter.
inline constexpr auto kLedBrightness = [] {
    using namespace palette;
    std::array<std::uint8_t, 256> brightness{};
    for (std::size_t led = 1; led < brightness.size(); ++led) {
        float const share = (static_cast<float>(led) - kDimmestLed) / (kBrightestLed - kDimmestLed);
        float const more = (kBrightestLedOnScreen - kDimmestLedOnScreen) * std::clamp(share, 0.0F, 1.0F);
        brightness[led] = static_cast<std::uint8_t>(kDimmestLedOnScreen + more + 0.5F);
    }
    return brightness;
}();

constexpr bool is_lit(Rgb led) {
    return led.r != 0 || led.g != 0 || led.b != 0;
}

/// The colour of a lit LED, and `dark` for one that is off; see ThemeColours::of_led(), too.
constexpr Pixel led_colour(Rgb led, Pixel dark = palette::kDarkLed) {
    auto const channel = [](std::uint8_t value, unsigned shift) { return Pixel{kLedBrightness[value]} << shift; };
    return is_lit(led) ? 0xFF000000U | channel(led.r, 16) | channel(led.g, 8) | channel(led.b, 0) : dark;
}

}  // namespace pogosim
