#include "base/exact_math.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "base/random.hpp"

namespace pogosim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(ExactMath, SineAndCosineAreThoseOfTheCLibrary) {
    RandomStream random(1, 0);
    for (int i = 0; i < 200000; ++i) {
        double const x = std::ldexp(static_cast<double>(random.uniform(-1.0F, 1.0F)), i % 20);
        exact::SineCosine const exact = exact::sine_cosine(x);
        EXPECT_NEAR(exact.sine, std::sin(x), 1e-11) << x;
        EXPECT_NEAR(exact.cosine, std::cos(x), 1e-11) << x;
    }
}

TEST(ExactMath, SineAndCosineOfQuarterTurnsAndOfNothing) {
    for (int quarter = -9; quarter <= 9; ++quarter) {
        exact::SineCosine const exact = exact::sine_cosine(quarter * std::numbers::pi / 2.0);
        EXPECT_NEAR(exact.sine, std::sin(quarter * std::numbers::pi / 2.0), 1e-15) << quarter;
        EXPECT_NEAR(exact.cosine, std::cos(quarter * std::numbers::pi / 2.0), 1e-15) << quarter;
    }
    EXPECT_EQ(exact::sine_cosine(0.0).sine, 0.0);
    EXPECT_EQ(exact::sine_cosine(0.0).cosine, 1.0);
    EXPECT_TRUE(std::isnan(exact::sine_cosine(kInfinity).sine));
    EXPECT_TRUE(std::isnan(exact::sine_cosine(std::numeric_limits<double>::quiet_NaN()).cosine));
}

TEST(ExactMath, SineAndCosineStayOnTheUnitCircleHoweverLargeTheAngle) {
    for (double x = 1.0; x < 1e9; x *= 1.37) {
        exact::SineCosine const exact = exact::sine_cosine(x);
        EXPECT_NEAR(exact.sine * exact.sine + exact.cosine * exact.cosine, 1.0, 1e-11) << x;
        EXPECT_NEAR(exact.sine, std::sin(x), 1e-6) << x;
    }
}

TEST(ExactMath, LogarithmIsThatOfTheCLibrary) {
    RandomStream random(1, 1);
    for (int i = 0; i < 200000; ++i) {
        double const x = std::ldexp(0.5 + 0.5 * static_cast<double>(random.uniform()), i % 200 - 100);
        EXPECT_NEAR(exact::log(x), std::log(x), 1e-13 * std::max(std::abs(std::log(x)), 1e-3)) << x;
    }
    EXPECT_EQ(exact::log(1.0), 0.0);
}

TEST(ExactMath, ExponentialIsThatOfTheCLibrary) {
    for (double x = -690.0; x < 690.0; x += 0.0137) {
        EXPECT_NEAR(exact::exp(x) / std::exp(x), 1.0, 1e-12) << x;
    }
    EXPECT_EQ(exact::exp(0.0), 1.0);
    EXPECT_EQ(exact::exp(-800.0), 0.0);
    EXPECT_EQ(exact::exp(-kInfinity), 0.0);
    EXPECT_EQ(exact::exp(800.0), kInfinity);
    EXPECT_TRUE(std::isnan(exact::exp(std::numeric_limits<double>::quiet_NaN())));
}

TEST(ExactMath, PowersAreThoseOfTheCLibrary) {
    RandomStream random(1, 2);
    for (int i = 0; i < 100000; ++i) {
        double const x = static_cast<double>(random.uniform(1e-3F, 100.0F));
        double const y = static_cast<double>(random.uniform(-5.0F, 5.0F));
        EXPECT_NEAR(exact::pow(x, y) / std::pow(x, y), 1.0, 1e-12) << x << " " << y;
    }
    EXPECT_EQ(exact::pow(0.0, 0.0), 1.0);
    EXPECT_EQ(exact::pow(0.0, 2.5), 0.0);
    EXPECT_EQ(exact::pow(0.0, -1.0), kInfinity);
    EXPECT_EQ(exact::pow(7.0, 0.0), 1.0);
    EXPECT_TRUE(std::isnan(exact::pow(-1.0, 2.0)));
}

TEST(ExactMath, AnglesAreThoseOfTheCLibrary) {
    RandomStream random(1, 4);
    for (int i = 0; i < 200000; ++i) {
        double const x = std::ldexp(static_cast<double>(random.uniform(-1.0F, 1.0F)), i % 40 - 20);
        double const y = std::ldexp(static_cast<double>(random.uniform(-1.0F, 1.0F)), i / 40 % 40 - 20);
        double const expected = std::atan2(y, x);
        EXPECT_NEAR(exact::atan2(y, x), expected, 2e-15 * std::abs(expected)) << y << " " << x;
    }
}

TEST(ExactMath, AnglesOfAxesDiagonalsAndInfinitePoints) {
    for (double const x : {-kInfinity, -2.0, -0.0, 0.0, 2.0, kInfinity}) {
        for (double const y : {-kInfinity, -2.0, -0.0, 0.0, 2.0, kInfinity}) {
            EXPECT_NEAR(exact::atan2(y, x), std::atan2(y, x), 1e-15) << y << " " << x;
            EXPECT_EQ(std::signbit(exact::atan2(y, x)), std::signbit(y)) << y << " " << x;
        }
    }
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(std::isnan(exact::atan2(nan, 1.0)));
    EXPECT_TRUE(std::isnan(exact::atan2(1.0, nan)));
}

TEST(ExactMath, ArcSineIsThatOfTheCLibrary) {
    for (double x = -1.0; x <= 1.0; x += 1e-5) {
        EXPECT_NEAR(exact::asin(x), std::asin(x), 1e-15 + 1e-15 * std::abs(std::asin(x))) << x;
    }
    EXPECT_DOUBLE_EQ(exact::asin(1.0), std::numbers::pi / 2.0);
    EXPECT_EQ(exact::asin(0.0), 0.0);
    EXPECT_TRUE(std::isnan(exact::asin(1.5)));
}

TEST(ExactMath, HypotenuseIsTheNearestFloat) {
    RandomStream random(1, 5);
    for (int i = 0; i < 100000; ++i) {
        float const x = std::ldexp(random.uniform(-1.0F, 1.0F), i % 200 - 100);
        float const y = std::ldexp(random.uniform(-1.0F, 1.0F), i % 200 - 100);
        EXPECT_FLOAT_EQ(exact::hypot(x, y), std::hypot(x, y)) << x << " " << y;
    }
    EXPECT_EQ(exact::hypot(3e-30F, 4e-30F), 5e-30F);
    EXPECT_EQ(exact::hypot(-3e30F, 4e30F), 5e30F);
    EXPECT_EQ(exact::hypot(0.0F, -2.0F), 2.0F);
}

/// The bits themselves: what a compiler or processor that rounds otherwise changes.
TEST(ExactMath, GivesTheSameBitsEverywhere) {
    std::uint64_t hash = 0;
    auto const add = [&](double number) { hash = mix64(hash ^ std::bit_cast<std::uint64_t>(number)); };
    RandomStream random(1, 3);
    for (int i = 0; i < 10000; ++i) {
        auto const x = static_cast<double>(random.uniform(0.001F, 50.0F));
        add(exact::sine_cosine(x).sine);
        add(exact::sine_cosine(-x).cosine);
        add(exact::log(x));
        add(exact::exp(x - 25.0));
        add(exact::pow(x, 1.7));
        add(static_cast<double>(random.normal()));
        add(exact::atan2(x - 25.0, x - 10.0));
        add(exact::asin(0.02 * x));
        add(static_cast<double>(exact::hypot(static_cast<float>(x), 0.7F)));
    }
    EXPECT_EQ(hash, 15950298054183256345U);
}

}  // namespace
}  // namespace pogosim
