// The mode of the floating-point unit: how it rounds, whether it takes denormal numbers for zero, and which exceptions
// trap. Each thread has one. The simulator computes in the standard mode, that of the C language: to nearest, with
// denormal numbers, without traps.
#pragma once

#include <cstdint>

namespace pogosim {

/// The registers that set the mode, without the flags of past exceptions.
struct FloatingPointMode {
#if defined(__x86_64__)
    std::uint32_t vector_unit = 0x1f80;  // MXCSR
    std::uint16_t x87 = 0x037f;
#elif defined(__aarch64__)
    std::uint64_t control = 0;  // FPCR
#endif

    friend bool operator==(FloatingPointMode const&, FloatingPointMode const&) = default;
};

inline constexpr FloatingPointMode kStandardMode{};

inline FloatingPointMode floating_point_mode() {
    FloatingPointMode mode;
#if defined(__x86_64__)
    constexpr std::uint32_t vector_bits = 0xffc0;
    constexpr std::uint16_t x87_bits = 0x0f3f;
    constexpr std::uint16_t x87_reserved = 0x0040;  // always set
    asm volatile("stmxcsr %0" : "=m"(mode.vector_unit));
    asm volatile("fnstcw %0" : "=m"(mode.x87));
    mode.vector_unit &= vector_bits;
    mode.x87 = static_cast<std::uint16_t>((mode.x87 & x87_bits) | x87_reserved);
#elif defined(__aarch64__)
    asm volatile("mrs %0, fpcr" : "=r"(mode.control));
#endif
    return mode;
}

inline void set_floating_point_mode(FloatingPointMode const& mode) {
#if defined(__x86_64__)
    asm volatile("fnclex; fldcw %0" : : "m"(mode.x87));  // an old exception must not trap now
    asm volatile("ldmxcsr %0" : : "m"(mode.vector_unit));
#elif defined(__aarch64__)
    asm volatile("msr fpcr, %0" : : "r"(mode.control));
#else
    static_cast<void>(mode);
#endif
}

/// As long as this lives, this thread is in the standard mode; then it is in the one before.
class StandardFloatingPoint {
public:
    StandardFloatingPoint() : before_(floating_point_mode()) { set_floating_point_mode(kStandardMode); }
    ~StandardFloatingPoint() { set_floating_point_mode(before_); }
    StandardFloatingPoint(StandardFloatingPoint const&) = delete;
    StandardFloatingPoint& operator=(StandardFloatingPoint const&) = delete;

private:
    FloatingPointMode before_;
};

}  // namespace pogosim
