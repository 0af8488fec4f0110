// Random streams. Every robot, and every stage that draws, owns a stream seeded by (run seed, stream id), so that an
// additional robot or draw does not change the numbers of any other.
//
// Generator: PCG-XSH-RR 64/32, M. E. O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good
// Algorithms for Random Number Generation", Harvey Mudd College HMC-CS-2014-0905, 2014. Seeds are spread with the
// finaliser of SplitMix64, G. L. Steele, D. Lea and C. H. Flood, "Fast Splittable Pseudorandom Number Generators",
// OOPSLA 2014. The distributions are ours because those of <random> differ between standard libraries.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>

#include "base/exact_math.hpp"

namespace pogosim {

/// Bijective mix of 64 bits.
constexpr std::uint64_t mix64(std::uint64_t z) {
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31U);
}

class RandomStream {
public:
    RandomStream() : RandomStream(0, 0) {}

    /// Streams with different (seed, stream) pairs are independent for every practical purpose.
    RandomStream(std::uint64_t seed, std::uint64_t stream)
        : state_(0), increment_(mix64(stream + 0x9e3779b97f4a7c15ULL) | 1U) {
        bits();
        state_ += mix64(seed ^ mix64(stream));
        bits();
    }

    /// 32 uniform bits.
    std::uint32_t bits() {
        std::uint64_t const old = state_;
        state_ = old * kMultiplier + increment_;
        return output(old);
    }

    /// Uniform in [0, 1), 24 bits.
    float uniform() { return static_cast<float>(bits() >> 8U) * 0x1p-24F; }

    /// Makes `hits.size()` draws as uniform() does. Writes the numbers, from 0 on and in their order, of those below
    /// `probability` to the front of `hits`, and returns how many there are.
    std::size_t hits_of(float probability, std::span<std::uint32_t> hits) {
        // Compares whole numbers, which decides as single precision does, since its products with powers of two are
        // exact.
        auto const limit = static_cast<std::uint64_t>(std::ceil(std::clamp(probability, 0.0F, 1.0F) * 0x1p24F)) << 8U;
        // Four draws at a time: a draw has to wait for the fourth before it, not for the last one.
        constexpr std::uint64_t multiplier2 = kMultiplier * kMultiplier;
        std::uint64_t const increment4 = increment_ * (1U + kMultiplier) * (1U + multiplier2);
        std::array<std::uint64_t, 4> states{state_};
        for (std::size_t k = 1; k < states.size(); ++k) {
            states[k] = states[k - 1] * kMultiplier + increment_;
        }
        std::uint32_t next = 0;
        std::size_t count = 0;
        for (; next + states.size() <= hits.size(); next += static_cast<std::uint32_t>(states.size())) {
            for (std::uint32_t k = 0; k < states.size(); ++k) {
                hits[count] = next + k;  // without a branch, which could not be predicted
                count += output(states[k]) < limit ? 1U : 0U;
                states[k] = states[k] * (multiplier2 * multiplier2) + increment4;
            }
        }
        state_ = states[0];
        for (; next < hits.size(); ++next) {
            hits[count] = next;
            count += bits() < limit ? 1U : 0U;
        }
        return count;
    }

    /// Uniform in [low, high).
    float uniform(float low, float high) { return low + (high - low) * uniform(); }

    /// Uniform integer in [0, bound); bound > 0. Lemire's multiplication without the rejection step: the bias is below
    /// bound / 2^32.
    std::uint32_t below(std::uint32_t bound) {
        return static_cast<std::uint32_t>((static_cast<std::uint64_t>(bits()) * bound) >> 32U);
    }

    /// Normal deviate of mean 0 and standard deviation 1 (Box and Muller, 1958; one of the pair is used).
    float normal() {
        float const u = 1.0F - uniform();  // in (0, 1]
        float const v = uniform();
        auto const radius = static_cast<float>(std::sqrt(-2.0 * exact::log(static_cast<double>(u))));
        constexpr double turn = 2.0 * std::numbers::pi_v<double>;
        return radius * static_cast<float>(exact::sine_cosine(turn * static_cast<double>(v)).cosine);
    }

    friend bool operator==(RandomStream const&, RandomStream const&) = default;

private:
    static constexpr std::uint64_t kMultiplier = 6364136223846793005ULL;

    static std::uint32_t output(std::uint64_t state) {
        auto const shifted = static_cast<std::uint32_t>(((state >> 18U) ^ state) >> 27U);
        auto const turn = static_cast<std::uint32_t>(state >> 59U);
        return (shifted >> turn) | (shifted << ((32U - turn) & 31U));
    }

    std::uint64_t state_;
    std::uint64_t increment_;
};

}  // namespace pogosim
