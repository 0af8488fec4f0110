#include "base/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pogosim {
namespace {

constexpr int kDraws = 200000;

TEST(RandomStream, SameSeedAndStreamGiveTheSameNumbers) {
    RandomStream a(5, 9);
    RandomStream b(5, 9);
    RandomStream other_stream(5, 10);
    RandomStream other_seed(6, 9);
    int same_stream = 0;
    int same_seed = 0;
    for (int i = 0; i < 1000; ++i) {
        std::uint32_t const bits = a.bits();
        EXPECT_EQ(bits, b.bits());
        same_stream += bits == other_stream.bits() ? 1 : 0;
        same_seed += bits == other_seed.bits() ? 1 : 0;
    }
    EXPECT_LE(same_stream, 1);
    EXPECT_LE(same_seed, 1);
}

TEST(RandomStream, UniformHasTheMomentsOfTheUniformLaw) {
    RandomStream random(1, 2);
    double sum = 0.0;
    double squares = 0.0;
    for (int i = 0; i < kDraws; ++i) {
        double const u = random.uniform();
        EXPECT_GE(u, 0.0);
        EXPECT_LT(u, 1.0);
        sum += u;
        squares += u * u;
    }
    EXPECT_NEAR(sum / kDraws, 0.5, 4.0 * std::sqrt(1.0 / 12.0 / kDraws));
    EXPECT_NEAR(squares / kDraws, 1.0 / 3.0, 4.0 * std::sqrt(4.0 / 45.0 / kDraws));
}

TEST(RandomStream, NormalHasTheMomentsOfTheNormalLaw) {
    RandomStream random(1, 3);
    double sum = 0.0;
    double squares = 0.0;
    double fourth = 0.0;
    for (int i = 0; i < kDraws; ++i) {
        double const z = random.normal();
        sum += z;
        squares += z * z;
        fourth += z * z * z * z;
    }
    EXPECT_NEAR(sum / kDraws, 0.0, 4.0 / std::sqrt(kDraws));
    EXPECT_NEAR(squares / kDraws, 1.0, 4.0 * std::sqrt(2.0 / kDraws));
    EXPECT_NEAR(fourth / kDraws, 3.0, 4.0 * std::sqrt(96.0 / kDraws));
}

TEST(RandomStream, BelowIsUniformOverItsRange) {
    RandomStream random(1, 4);
    std::array<int, 10> counts{};
    for (int i = 0; i < kDraws; ++i) {
        ++counts[random.below(10)];
    }
    double chi_squared = 0.0;
    for (int const count : counts) {
        chi_squared += std::pow(count - kDraws / 10.0, 2) / (kDraws / 10.0);
    }
    EXPECT_LT(chi_squared, 27.9);  // 9 degrees of freedom, 0.1 %
}

TEST(RandomStream, NeighbouringStreamsAreNotCorrelated) {
    double sum = 0.0;
    for (int i = 0; i < kDraws; ++i) {
        RandomStream a(42, static_cast<std::uint64_t>(i));
        RandomStream b(42, static_cast<std::uint64_t>(i) + 1);
        sum += (a.uniform() - 0.5) * (b.uniform() - 0.5);
    }
    EXPECT_NEAR(sum / kDraws, 0.0, 4.0 / 12.0 / std::sqrt(kDraws));
}

TEST(RandomStream, HitsAreTheDrawsBelowTheProbability) {
    for (float const probability : {-1.0F, 0.0F, 1e-30F, 0x1p-24F, 0.1F, 0.3F, 0.5F, 1.0F - 0x1p-24F, 1.0F, 2.0F}) {
        for (std::size_t const count : {0U, 1U, 3U, 4U, 5U, 6U, 1000U}) {
            RandomStream one_by_one(3, 7);
            RandomStream together(3, 7);
            std::vector<std::uint32_t> expected;
            for (std::uint32_t i = 0; i < count; ++i) {
                if (one_by_one.uniform() < probability) {
                    expected.push_back(i);
                }
            }
            std::vector<std::uint32_t> hits(count);
            hits.resize(together.hits_of(probability, hits));
            EXPECT_EQ(hits, expected) << probability << ", " << count;
            EXPECT_EQ(together, one_by_one) << probability << ", " << count;
        }
    }
}

}  // namespace
}  // namespace pogosim
