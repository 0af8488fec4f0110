#include "base/half.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pogosim {

namespace {

constexpr std::uint16_t kSign = 0x8000;
constexpr std::uint16_t kInfinity = 0x7C00;
constexpr std::uint16_t kNan = 0x7E00;
constexpr int kMantissaBits = 10;
constexpr int kMinExponent = -14;      // of normal numbers
constexpr double kOverflow = 65520.0;  // halfway between the largest half, 65504, and the next power of two

std::uint16_t magnitude_to_half(double magnitude) {
    if (std::isnan(magnitude)) {
        return kNan;
    }
    if (magnitude >= kOverflow) {
        return kInfinity;
    }
    // Counts the value in units of its last mantissa bit. Normal numbers give 1024 to 2048, subnormal ones less; a
    // count that rounds up to 2048 carries into the exponent by itself.
    int const exponent = std::max(magnitude > 0.0 ? std::ilogb(magnitude) : kMinExponent, kMinExponent);
    double const units = std::nearbyint(std::ldexp(magnitude, kMantissaBits - exponent));
    return static_cast<std::uint16_t>(((exponent - kMinExponent) << kMantissaBits) + static_cast<int>(units));
}

}  // namespace

std::uint16_t to_half(double value) {
    std::uint16_t const sign = std::signbit(value) ? kSign : std::uint16_t{0};
    return sign | magnitude_to_half(std::abs(value));
}

double from_half(std::uint16_t bits) {
    int const biased = (bits & kInfinity) >> kMantissaBits;
    int const mantissa = bits & ((1 << kMantissaBits) - 1);
    double magnitude = 0.0;
    if ((bits & kInfinity) == kInfinity) {
        magnitude = mantissa == 0 ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
    } else {
        // The reverse of the count above; 0 is the exponent of subnormal numbers.
        int const units = biased == 0 ? mantissa : mantissa + (1 << kMantissaBits);
        magnitude = std::ldexp(units, std::max(biased, 1) - 1 + kMinExponent - kMantissaBits);
    }
    return (bits & kSign) != 0 ? -magnitude : magnitude;
}

}  // namespace pogosim
