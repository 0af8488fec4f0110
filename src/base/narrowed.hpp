// From double to float, for every value: the language leaves open what happens to one that is too large.
#pragma once

#include <cmath>
#include <limits>

namespace pogosim {

/// The nearest float; infinite if none is near.
inline float narrowed(double value) {
    constexpr double largest = std::numeric_limits<float>::max();
    constexpr float infinite = std::numeric_limits<float>::infinity();
    if (value > largest) {
        return infinite;
    }
    return value < -largest ? -infinite : static_cast<float>(value);
}

}  // namespace pogosim
