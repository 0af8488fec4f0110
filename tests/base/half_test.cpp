#include "base/half.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace pogosim {
namespace {

constexpr int kInfinityBits = 0x7C00;

/// Value of a half-precision number, from the definition of the format.
double by_definition(int bits) {
    int const exponent = (bits >> 10) & 0x1F;
    int const mantissa = bits & 0x3FF;
    double const sign = (bits & 0x8000) != 0 ? -1.0 : 1.0;
    if (exponent == 0x1F) {
        return mantissa == 0 ? sign * std::numeric_limits<double>::infinity() : std::nan("");
    }
    return exponent == 0 ? sign * std::ldexp(mantissa, -24) : sign * std::ldexp(1024 + mantissa, exponent - 25);
}

TEST(Half, EachOfThe65536NumbersComesBackAsItself) {
    for (int bits = 0; bits <= 0xFFFF; ++bits) {
        double const value = by_definition(bits);
        if (std::isnan(value)) {
            EXPECT_TRUE(std::isnan(by_definition(to_half(value)))) << bits;
        } else {
            EXPECT_EQ(to_half(value), bits) << value;
        }
    }
}

TEST(Half, HalfwayBetweenNeighboursGoesToTheEvenOneAndElseToTheNearest) {
    // The number after the largest finite one would be 65536; there stands infinity.
    for (int low = 0; low < kInfinityBits; ++low) {
        int const high = low + 1;
        double const value_high = high == kInfinityBits ? 65536.0 : by_definition(high);
        double const middle = (by_definition(low) + value_high) / 2.0;
        int const even = low % 2 == 0 ? low : high;
        EXPECT_EQ(to_half(middle), even) << middle;
        EXPECT_EQ(to_half(std::nextafter(middle, 0.0)), low) << middle;
        EXPECT_EQ(to_half(std::nextafter(middle, 1.0e9)), high) << middle;
        EXPECT_EQ(to_half(-middle), even | 0x8000) << middle;
    }
}

TEST(Half, TooLargeBecomesInfinityAndTooSmallBecomesZeroOfTheSameSign) {
    EXPECT_EQ(to_half(std::numeric_limits<double>::max()), 0x7C00);
    EXPECT_EQ(to_half(-1.0e10), 0xFC00);
    EXPECT_EQ(to_half(std::numeric_limits<double>::denorm_min()), 0x0000);
    EXPECT_EQ(to_half(-1.0e-30), 0x8000);
    EXPECT_EQ(to_half(-0.0), 0x8000);
}

TEST(Half, NanStaysNanWithItsSign) {
    EXPECT_TRUE(std::isnan(by_definition(to_half(std::nan("")))));
    EXPECT_TRUE(std::isnan(by_definition(to_half(std::copysign(std::nan("1"), -1.0)))));
    EXPECT_TRUE(std::isnan(by_definition(to_half(std::numeric_limits<float>::signaling_NaN()))));
}

}  // namespace

TEST(Half, BitsAreTheNumberOfTheDefinition) {
    for (int bits = 0; bits < 0x10000; ++bits) {
        double const expected = by_definition(bits);
        double const value = from_half(static_cast<std::uint16_t>(bits));
        EXPECT_TRUE(std::isnan(expected) ? std::isnan(value) : value == expected) << bits;
        EXPECT_EQ(std::signbit(value), std::isnan(expected) ? std::signbit(value) : (bits & 0x8000) != 0) << bits;
    }
}

}  // namespace pogosim
