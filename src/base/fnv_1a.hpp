// The hash FNV-1a of 64 bits: G. Fowler, L. C. Noll and K.-P. Vo, "The FNV Non-Cryptographic Hash Algorithm", RFC 9923.
#pragma once

#include <cstdint>
#include <string_view>

namespace pogosim {

inline constexpr std::uint64_t kFnvBasis = 0xcbf29ce484222325ULL;
inline constexpr std::uint64_t kFnvPrime = 0x100000001b3ULL;

/// `hash`: that of the bytes before.
constexpr std::uint64_t fnv_1a(std::string_view bytes, std::uint64_t hash = kFnvBasis) {
    for (char const byte : bytes) {
        hash = (hash ^ static_cast<unsigned char>(byte)) * kFnvPrime;
    }
    return hash;
}

}  // namespace pogosim
