#include "base/four.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/random.hpp"

namespace pogosim {
namespace {

std::uint32_t bits(float x) {
    return std::bit_cast<std::uint32_t>(x);
}

TEST(Four, LanesHaveTheBitsOfSingleNumbers) {
    RandomStream random(1, 0);
    for (int i = 0; i < 10000; ++i) {
        std::array<float, kLanes> a{};
        std::array<float, kLanes> b{};
        for (std::uint32_t k = 0; k < kLanes; ++k) {
            a.at(k) = std::ldexp(random.uniform(0.0F, 1.0F), i % 60 - 30);
            b.at(k) = random.uniform(-1.0F, 1.0F);
        }
        Four const four_a{a[0], a[1], a[2], a[3]};
        Four const four_b{b[0], b[1], b[2], b[3]};
        Four const root = square_root(four_a);
        Four const sum = four_a * four_b + four_a;
        Four const inverse = 1.0F / four_b;
        Four const least = smaller(four_a, four_b);
        for (std::uint32_t k = 0; k < kLanes; ++k) {
            EXPECT_EQ(bits(root[k]), bits(std::sqrt(a.at(k))));
            EXPECT_EQ(bits(sum[k]), bits(a.at(k) * b.at(k) + a.at(k)));
            EXPECT_EQ(bits(inverse[k]), bits(1.0F / b.at(k)));
            EXPECT_EQ(bits(least[k]), bits(std::fmin(a.at(k), b.at(k))));
        }
    }
}

TEST(Four, MasksChooseByLanes) {
    Four const numbers{-1.0F, 0.0F, 2.0F, std::numeric_limits<float>::quiet_NaN()};
    FourInts const is_positive = numbers > 0.0F;
    EXPECT_EQ(is_positive[0], 0);
    EXPECT_EQ(is_positive[1], 0);
    EXPECT_EQ(is_positive[2], -1);
    EXPECT_EQ(is_positive[3], 0);
    Four const chosen = is_positive ? numbers : all_four(7.0F);
    EXPECT_EQ(chosen[0], 7.0F);
    EXPECT_EQ(chosen[2], 2.0F);
    EXPECT_TRUE(is_any(is_positive));
    EXPECT_FALSE(is_any(numbers > 2.0F));
}

TEST(Four, MasksAreBits) {
    for (unsigned bits = 0; bits < 16; ++bits) {
        EXPECT_EQ(bits_of(mask_of(bits)), bits);
    }
    EXPECT_EQ(bits_of(Four{1.0F, -1.0F, -1.0F, 1.0F} > 0.0F), 0b1001U);
}

TEST(Four, SmallestIsInAllLanes) {
    for (Four const numbers : {Four{1.0F, 2.0F, 3.0F, 4.0F}, Four{2.0F, 1.0F, 3.0F, 4.0F}, Four{4.0F, 3.0F, 1.0F, 2.0F},
                               Four{4.0F, 3.0F, 2.0F, 1.0F}}) {
        EXPECT_EQ(bits_of(smallest(numbers) == all_four(1.0F)), 0xFU);
    }
}

TEST(Four, RowsBecomeColumns) {
    auto const [x, y, z, w] = transposed({.x = Four{0.0F, 1.0F, 2.0F, 3.0F},
                                          .y = Four{10.0F, 11.0F, 12.0F, 13.0F},
                                          .z = Four{20.0F, 21.0F, 22.0F, 23.0F},
                                          .w = Four{30.0F, 31.0F, 32.0F, 33.0F}});
    for (std::uint32_t row = 0; row < kLanes; ++row) {
        auto const ten = 10.0F * static_cast<float>(row);
        EXPECT_EQ(x[row], ten);
        EXPECT_EQ(y[row], ten + 1.0F);
        EXPECT_EQ(z[row], ten + 2.0F);
        EXPECT_EQ(w[row], ten + 3.0F);
    }
}

}  // namespace
}  // namespace pogosim
