// Random numbers of robots' programs: the answers of pogobot_helper_getRandSeed(), and the streams of rand().
#pragma once

#include <cstdint>

#include "base/random.hpp"
#include "world/world.hpp"

namespace pogosim {

/// What pogobot_helper_getRandSeed() gives a robot: first a number that no other robot gets, then random ones.
struct RandomSeeds {
    std::int16_t first = 0;
    bool is_first_taken = false;
    RandomStream later{};

    std::int16_t next() {
        if (!is_first_taken) {
            is_first_taken = true;
            return first;
        }
        return static_cast<std::int16_t>(later.bits());
    }
};

/// Those of a robot (kNone: the global step), whose id is id_on_air(), in the run with this seed.
inline RandomSeeds random_seeds(std::uint64_t seed, std::uint32_t robot, std::uint16_t id) {
    constexpr std::uint64_t streams = std::uint64_t{2} << 32U;
    // A bijection of 16 bits, so that the first seeds of up to 65536 robots differ.
    std::uint64_t const key = mix64(seed + 1);
    auto const odd_factor = static_cast<std::uint16_t>(key | 1U);
    auto const offset = static_cast<std::uint16_t>(key >> 16U);
    auto const scattered = static_cast<std::uint16_t>(unsigned{id} * odd_factor + offset);
    return {.first = static_cast<std::int16_t>(scattered), .later = RandomStream(seed, streams + robot)};
}

/// The stream of rand() with which a robot's program starts.
inline RandomStream random_of_program(std::uint64_t seed, std::uint32_t robot) {
    constexpr std::uint64_t first_stream = std::uint64_t{1} << 32U;
    return {seed, first_stream + robot};
}

/// The stream of srand(seed): the same numbers for the same seed on every robot, as on the real ones.
inline RandomStream stream_of_seed(unsigned seed) {
    return {seed, 0x72616e64};
}

/// The next number of rand(), from 0 to 2^31 - 1.
inline int random_number(RandomStream& stream) {
    return static_cast<int>(stream.bits() & 0x7fffffffU);
}

}  // namespace pogosim
