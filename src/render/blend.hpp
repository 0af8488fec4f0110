// Colours laid over pixels.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "render/canvas.hpp"

namespace pogosim {

/// Lays a colour with an opacity of 0 to 256 over a pixel. Opaque pixels stay opaque; others become more so, with
/// colours premultiplied by alpha: T. Porter and T. Duff, "Compositing Digital Images", SIGGRAPH 1984.
inline Pixel blended(Pixel below, Pixel colour, std::uint32_t opacity) {
    std::uint32_t const rest = 256U - opacity;
    std::uint32_t const over = colour | 0xFF000000U;
    std::uint32_t const red_blue = ((below & 0xFF00FFU) * rest + (over & 0xFF00FFU) * opacity + 0x800080U) >> 8U;
    std::uint32_t const alpha_green =
        ((below >> 8U) & 0xFF00FFU) * rest + ((over >> 8U) & 0xFF00FFU) * opacity + 0x800080U;
    return (red_blue & 0xFF00FFU) | (alpha_green & 0xFF00FF00U);
}

/// The sum of each channel, 255 at most.
inline Pixel saturated_sum(Pixel a, Pixel b) {
    auto const sum = [](std::uint32_t lanes_a, std::uint32_t lanes_b) {
        std::uint32_t const lanes = lanes_a + lanes_b;
        std::uint32_t const overflow = lanes & 0x01000100U;
        return (lanes | (overflow - (overflow >> 8U))) & 0xFF00FFU;
    };
    return sum(a & 0xFF00FFU, b & 0xFF00FFU) | sum((a >> 8U) & 0xFF00FFU, (b >> 8U) & 0xFF00FFU) << 8U;
}

/// Opacity of a colour, 0 to 256.
inline float opacity_of(Pixel colour) {
    return static_cast<float>(colour >> 24U) * (256.0F / 255.0F);
}

/// Rounds a number that is not negative. (By a signed integer: that is one instruction.)
inline std::uint32_t rounded(float value) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(value + 0.5F));
}

/// Blends by a coverage of 0 to 1 and an opacity of 0 to 256.
inline void blend(Pixel& pixel, Pixel colour, float coverage, float opacity) {
    pixel = blended(pixel, colour, rounded(coverage * opacity));
}

inline float clamp01(float value) {
    return std::clamp(value, 0.0F, 1.0F);
}

/// Rounds down to a whole number, within limits; NaN gives the lower limit.
inline int floor_within(float value, int low, int high) {
    if (!(value > static_cast<float>(low))) {
        return low;
    }
    return value >= static_cast<float>(high) ? high : static_cast<int>(std::floor(value));
}

}  // namespace pogosim
