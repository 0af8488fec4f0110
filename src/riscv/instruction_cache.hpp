// The instruction cache of the robots' processor: which lines of memory it holds.
//
// VexRiscv "Lite" has 2 KiB in lines of 32 bytes, one way (iCacheSize 2048 in the Makefile named in cycle_costs.hpp; 32
// bytes a line and one way are the defaults of its generator, GenCoreDefault.scala). So each line of memory has one
// place in it, which it shares with all lines that are a multiple of 2 KiB away.
#pragma once

#include <array>
#include <cstdint>

namespace pogosim {

inline constexpr std::uint32_t kCacheLineBytes = 32;
inline constexpr std::uint32_t kCacheLines = 64;

/// The number of the line in which an address is.
constexpr std::uint32_t cache_line(std::uint32_t address) {
    return address / kCacheLineBytes;
}

struct InstructionCache {
    std::array<std::uint32_t, kCacheLines> held{};  // in each place: 1 + the number of the line; 0: none
    std::uint64_t misses = 0;

    /// Whether a line had to be fetched from memory. It takes the place of the one before.
    bool fetches(std::uint32_t line) {
        std::uint32_t& place = held[line % kCacheLines];
        if (place == line + 1) [[likely]] {
            return false;
        }
        place = line + 1;
        ++misses;
        return true;
    }

    bool operator==(InstructionCache const&) const = default;
};

}  // namespace pogosim
