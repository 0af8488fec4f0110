// Simulated times as users see them, in files and in names.
#pragma once

#include <cmath>

namespace pogosim {

/// The time in s, rounded to 1 ns: the number that "0.3" is read as, not 0.30000000000000004, the product of 3 and 0.1.
/// Rows of one time then have equal times, whatever the time step of their run was.
inline double rounded_to_ns(double time_s) {
    constexpr double kNsPerS = 1e9;
    return std::round(time_s * kNsPerS) / kNsPerS;
}

}  // namespace pogosim
