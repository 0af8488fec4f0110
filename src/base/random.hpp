// Random streams. Every robot, and every stage that draws, owns a stream seeded by (run seed, stream id), so that an
// additional robot or draw does not change the numbers of any other.
//
// Generator: PCG-XSH-RR 64/32, M. E. O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good
// Algorithms for Random Number Generation", Harvey Mudd College HMC-CS-2014-0905, 2014. Seeds are spread with the
// finaliser of SplitMix64, G. L. Steele, D. Lea and C. H. Flood, "Fast Splittable Pseudorandom Number Generators",
// OOPSLA 2014. The distributions are ours because those of <random> differ between standard libraries.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

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
        state_ = old * 6364136223846793005ULL + increment_;
        auto const shifted = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
        auto const turn = static_cast<std::uint32_t>(old >> 59U);
        return (shifted >> turn) | (shifted << ((32U - turn) & 31U));
    }

    /// Uniform in [0, 1), 24 bits.
    float uniform() { return static_cast<float>(bits() >> 8U) * 0x1p-24F; }

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
    std::uint64_t state_;
    std::uint64_t increment_;
};

}  // namespace pogosim
