// Values between the centres of cells, for maps that are drawn bilinearly.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pogosim {

/// The cells on both sides of a place along one axis.
struct Between {
    std::size_t low = 0;
    std::size_t high = 0;
    float share = 0.0F;  // of the higher one
};

/// `place`: in cells from the border of the first one. Beyond the outer centres, that of the nearest cell holds.
inline Between between(float place, int count) {
    float const within = std::clamp(place - 0.5F, 0.0F, static_cast<float>(count - 1));
    auto const low = static_cast<std::size_t>(within);
    return {low, std::min(low + 1, static_cast<std::size_t>(count - 1)), within - std::floor(within)};
}

}  // namespace pogosim
