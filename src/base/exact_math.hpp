// Elementary functions that give the same bits on every machine and with every compiler: additions, multiplications,
// divisions and square roots of double in a fixed order, and a rounding to float at the end. Those of the C library may
// differ in the last bit from one library to the next, and the motion of a swarm amplifies such a difference.
//
// Series of M. Abramowitz and I. A. Stegun, "Handbook of Mathematical Functions" (1964), 4.1.27, 4.2.1, 4.3.65, 4.3.66
// and 4.4.42, arguments reduced as in W. J. Cody and W. Waite, "Software Manual for the Elementary Functions" (1980).
// They need -ffp-contract=off, and only those parts of IEEE 754 that all current processors implement.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace pogosim::exact {

/// Added to a number below 2^51, it leaves no bits for the fraction.
inline constexpr double kShift = 0x1.8p52;

/// Nearest whole number, for |x| < 2^51.
constexpr double nearest(double x) {
    return x + kShift - kShift;
}

struct SineCosine {
    double sine;
    double cosine;
};

/// For |x| < 10^6 with an error below 10^-11; above, far below the spacing of float. Branch-free: the quadrant of a
/// robot's angle cannot be predicted.
constexpr SineCosine sine_cosine(double x) {
    // pi / 2 in two parts, the first of 33 bits.
    constexpr double high = 0x1.921fb544p+0;
    constexpr double low = 0x1.0b4611a626331p-34;
    double const shifted = x * 0x1.45f306dc9c883p-1 + kShift;  // its last bits are those of the quadrant number
    double const quarters = shifted - kShift;
    double const r = x - quarters * high - quarters * low;
    double const r2 = r * r;
    double const sine =
        r + r * r2 * (-1.0 / 6 + r2 * (1.0 / 120 + r2 * (-1.0 / 5040 + r2 * (1.0 / 362880 + r2 * (-1.0 / 39916800)))));
    double const cosine =
        1.0 +
        r2 * (-1.0 / 2 + r2 * (1.0 / 24 + r2 * (-1.0 / 720 +
                                                r2 * (1.0 / 40320 + r2 * (-1.0 / 3628800 + r2 * (1.0 / 479001600))))));
    // (s, c), (c, -s), (-s, -c) and (-c, s) in the four quadrants.
    auto const quarter = std::bit_cast<std::uint64_t>(shifted);
    auto const s = std::bit_cast<std::uint64_t>(sine);
    auto const c = std::bit_cast<std::uint64_t>(cosine);
    std::uint64_t const swapped = (s ^ c) & (std::uint64_t{0} - (quarter & 1));
    return {std::bit_cast<double>(s ^ swapped ^ (quarter & 2) << 62U),
            std::bit_cast<double>(c ^ swapped ^ ((quarter + 1) & 2) << 62U)};
}

/// Natural logarithm of a positive, finite number that is not subnormal, with a relative error below 10^-13.
constexpr double log(double x) {
    // x = 2^exponent * m with m in [sqrt(1/2), sqrt(2)).
    constexpr std::uint64_t one = std::bit_cast<std::uint64_t>(1.0);
    constexpr std::uint64_t root_half = std::bit_cast<std::uint64_t>(0x1.6a09e667f3bcdp-1);
    auto const bits = std::bit_cast<std::uint64_t>(x);
    auto const exponent = static_cast<std::int64_t>(bits + (one - root_half)) / (std::int64_t{1} << 52) - 1023;
    double const m = std::bit_cast<double>(bits - static_cast<std::uint64_t>(exponent) * (std::uint64_t{1} << 52));
    double const s = (m - 1.0) / (m + 1.0);
    double const s2 = s * s;
    double const series =
        1.0 +
        s2 * (1.0 / 3 +
              s2 * (1.0 / 5 +
                    s2 * (1.0 / 7 + s2 * (1.0 / 9 + s2 * (1.0 / 11 + s2 * (1.0 / 13 + s2 * (1.0 / 15 + s2 / 17)))))));
    constexpr double ln2_high = 0x1.62e42feep-1;  // of 33 bits
    constexpr double ln2_low = 0x1.a39ef35793c76p-33;
    auto const e = static_cast<double>(exponent);
    return e * ln2_high + (e * ln2_low + 2.0 * s * series);
}

/// e to the power x, with a relative error below 10^-12; 0 or infinity outside the range of double.
constexpr double exp(double x) {
    if (!(x > -700.0)) {
        return x == x ? 0.0 : x;
    }
    if (x > 700.0) {
        return std::numeric_limits<double>::infinity();
    }
    constexpr double ln2_high = 0x1.62e42feep-1;
    constexpr double ln2_low = 0x1.a39ef35793c76p-33;
    double const power = nearest(x * 0x1.71547652b82fep+0);
    double const r = x - power * ln2_high - power * ln2_low;
    double series = 1.0;
    for (int n = 13; n > 0; --n) {
        series = 1.0 + r / n * series;
    }
    auto const exponent = static_cast<std::int64_t>(power);
    return series * std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52U);
}

/// x to the power y, for x >= 0, with a relative error of about 10^-12 where y log(x) is of the order of 10.
constexpr double pow(double x, double y) {
    if (y == 0.0) {
        return 1.0;
    }
    if (!(x > 0.0)) {
        return x == 0.0 ? (y > 0.0 ? 0.0 : std::numeric_limits<double>::infinity())
                        : std::numeric_limits<double>::quiet_NaN();
    }
    return exp(y * log(x));
}

/// Angle of the point (x, y) from +x, in [-pi, pi], as std::atan2, with a relative error below 10^-15 or so. NaN if
/// either argument is.
inline double atan2(double y, double x) {
    double const along_x = std::abs(x);
    double const along_y = std::abs(y);
    if (std::isnan(x) || std::isnan(y)) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    double const least = std::min(along_x, along_y);
    double const most = std::max(along_x, along_y);
    double const tangent = least == most ? (most == 0.0 ? 0.0 : 1.0) : least / most;
    // The arc tangent by a series (4.4.42), for a quarter of the angle: tan(a / 2) = t / (1 + sqrt(1 + t^2)).
    double const half = tangent / (1.0 + std::sqrt(1.0 + tangent * tangent));
    double const quarter = half / (1.0 + std::sqrt(1.0 + half * half));
    double const q2 = quarter * quarter;
    double series = 0.0;
    for (int n = 23; n > 0; n -= 2) {
        series = 1.0 / n - q2 * series;
    }
    double const acute = 4.0 * quarter * series;
    constexpr double pi = std::numbers::pi;
    double const from_x = along_y > along_x ? pi / 2.0 - acute : acute;
    double const upper = std::signbit(x) ? pi - from_x : from_x;
    return std::copysign(upper, y);
}

/// For |x| <= 1, in [-pi / 2, pi / 2]; NaN for others.
inline double asin(double x) {
    return atan2(x, std::sqrt((1.0 - x) * (1.0 + x)));
}

/// sqrt(x^2 + y^2), also where the squares exceed the range of float.
inline float hypot(float x, float y) {
    auto const wide_x = static_cast<double>(x);
    auto const wide_y = static_cast<double>(y);
    return static_cast<float>(std::sqrt(wide_x * wide_x + wide_y * wide_y));
}

}  // namespace pogosim::exact
