// Pictures as hosts get them.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "base/error.hpp"
#include "config/scenario.hpp"
#include "render/canvas.hpp"

namespace pogosim {

/// Throws ConfigError for a picture without pixels, or with too many.
inline PictureSize checked_size(std::int32_t width_px, std::int32_t height_px) {
    if (std::min(width_px, height_px) < 1 || std::max(width_px, height_px) > kMostPixels) {
        throw ConfigError(fmt::format("a picture has 1 to {} pixels in a row, and as many rows; found {} x {}",
                                      kMostPixels, width_px, height_px));
    }
    return {width_px, height_px};
}

/// Writes red, green and blue of each pixel, row by row; rows begin `stride_bytes` apart.
inline void copy_pixels(Canvas const& canvas, std::uint8_t* rgb, std::size_t stride_bytes) {
    auto const width = static_cast<std::size_t>(canvas.size().width_px);
    for (Pixel const* pixel = canvas.pixels().data(); pixel != canvas.pixels().data() + canvas.pixels().size();) {
        std::uint8_t* to = rgb;
        for (std::size_t x = 0; x < width; ++x) {
            *to++ = static_cast<std::uint8_t>(*pixel >> 16U);
            *to++ = static_cast<std::uint8_t>(*pixel >> 8U);
            *to++ = static_cast<std::uint8_t>(*pixel++);
        }
        rgb += stride_bytes;
    }
}

}  // namespace pogosim
