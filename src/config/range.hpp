// The range of numbers that a key takes.
#pragma once

#include <cmath>
#include <limits>
#include <string>

namespace pogosim {

/// An interval, whether the special numbers are welcome, and which numbers are so unusual that they look like ones in
/// another unit.
struct Range {
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
    bool without_min = false;  // min itself is outside
    bool with_infinity = false;
    bool with_nan = false;
    bool without_fraction = false;  // of integers: 1.5 is refused; else it is cut to 1, with a warning
    double usual_min = 0.0;         // of the absolute value; 0 itself is usual
    double usual_max = std::numeric_limits<double>::infinity();

    constexpr Range up_to(double new_max) const {
        Range range = *this;
        range.max = new_max;
        return range;
    }
    constexpr Range or_infinity() const {
        Range range = *this;
        range.with_infinity = true;
        return range;
    }
    constexpr Range or_nan() const {
        Range range = *this;
        range.with_nan = true;
        return range;
    }

    /// For integers that no older configuration has.
    constexpr Range whole() const {
        Range range = *this;
        range.without_fraction = true;
        return range;
    }

    /// Metres where millimetres are expected, say, are below.
    constexpr Range usually_from(double smallest) const {
        Range range = *this;
        range.usual_min = smallest;
        return range;
    }
    /// Degrees where radians are expected, say, are above.
    constexpr Range usually_up_to(double largest) const {
        Range range = *this;
        range.usual_max = largest;
        return range;
    }

    bool is_unusually_small(double value) const {
        // A value that a script has computed may miss 0 by a rounding error.
        constexpr double rounding = 1e-3;
        double const size = std::abs(value);
        return size > (min < 0.0 ? rounding * usual_min : 0.0) && size < usual_min;
    }
    bool is_unusually_large(double value) const { return std::isfinite(value) && std::abs(value) > usual_max; }

    bool contains(double value) const {
        if (std::isnan(value)) {
            return with_nan;
        }
        if (std::isinf(value)) {
            return with_infinity && value >= min;
        }
        return (without_min ? value > min : value >= min) && value <= max;
    }

    /// " above 0", " from 0 to 1", ...; empty when every number will do.
    std::string text() const;
};

constexpr Range any() {
    return {};
}
constexpr Range at_least(double min) {
    return {.min = min};
}
constexpr Range above(double min) {
    return {.min = min, .without_min = true};
}
constexpr Range between(double min, double max) {
    return {.min = min, .max = max};
}

/// A number in the usual notation: "1000000", "0.01", "1e+30", ".nan".
std::string number_text(double value);

}  // namespace pogosim
