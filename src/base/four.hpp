// Four numbers in one register, of SSE or NEON: vector types that gcc and clang share. Each lane gets the bits that the
// same operations give on single numbers, so that worlds develop to the same bytes with every compiler.
//
// Comparisons give all bits, -1, in the lanes in which they hold; `mask ? a : b` chooses by lanes.
#pragma once

#include <cmath>
#include <cstdint>

namespace pogosim {

inline constexpr std::uint32_t kLanes = 4;

using Four = float __attribute__((vector_size(16)));
using FourInts = std::int32_t __attribute__((vector_size(16)));

inline Four all_four(float x) {
    return Four{x, x, x, x};
}

inline Four square_root(Four x) {
    return Four{std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3])};
}

inline Four smaller(Four a, Four b) {
    return b < a ? b : a;
}

inline Four larger(Four a, Four b) {
    return a < b ? b : a;
}

/// Four lanes of two registers: 0 to 3 are those of `low`, 4 to 7 those of `high`.
template <std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d>
Four chosen_lanes(Four low, Four high) {
#if __has_builtin(__builtin_shufflevector)
    return __builtin_shufflevector(low, high, a, b, c, d);
#else  // gcc 11
    return __builtin_shuffle(low, high, FourInts{a, b, c, d});
#endif
}

/// The smallest lane, in all lanes.
inline Four smallest(Four x) {
    Four const pairs = smaller(x, chosen_lanes<2, 3, 0, 1>(x, x));
    return smaller(pairs, chosen_lanes<1, 0, 3, 2>(pairs, pairs));
}

inline bool is_any(FourInts mask) {
    return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
}

inline constexpr FourInts kLaneBits{1, 2, 4, 8};

/// Bit d for lane d of a mask.
inline unsigned bits_of(FourInts mask) {
    FourInts const bits = mask & kLaneBits;
    return static_cast<unsigned>(bits[0] | bits[1] | bits[2] | bits[3]);
}

/// The inverse of bits_of().
inline FourInts mask_of(unsigned bits) {
    auto const all = static_cast<std::int32_t>(bits);
    return (FourInts{all, all, all, all} & kLaneBits) != 0;
}

/// Transposes four rows into columns.
struct FourRows {
    Four x;
    Four y;
    Four z;
    Four w;
};
inline FourRows transposed(FourRows const& rows) {
    Four const low_xy = chosen_lanes<0, 4, 1, 5>(rows.x, rows.y);
    Four const low_zw = chosen_lanes<0, 4, 1, 5>(rows.z, rows.w);
    Four const high_xy = chosen_lanes<2, 6, 3, 7>(rows.x, rows.y);
    Four const high_zw = chosen_lanes<2, 6, 3, 7>(rows.z, rows.w);
    return {chosen_lanes<0, 1, 4, 5>(low_xy, low_zw), chosen_lanes<2, 3, 6, 7>(low_xy, low_zw),
            chosen_lanes<0, 1, 4, 5>(high_xy, high_zw), chosen_lanes<2, 3, 6, 7>(high_xy, high_zw)};
}

/// How many of four bits are set. (std::popcount() calls a function where the processor may be an old one.)
constexpr unsigned count_of_four(unsigned bits) {
    constexpr std::uint64_t counts = 0x4332'3221'3221'2110;
    return static_cast<unsigned>(counts >> (4U * bits) & 7U);
}

}  // namespace pogosim
