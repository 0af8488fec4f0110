// Counts multiples of a period, for what happens at the first step at or after each of them, without drift.
#pragma once

#include <cstdint>

#include "world/world.hpp"

namespace pogosim {

class Multiples {
public:
    /// `first`: 0 or 1, the first multiple that counts. If the period is not positive, only the multiple 0 exists.
    Multiples(double period_s, std::int64_t first) : period_s_(period_s), next_(first) {}

    /// How many multiples have been reached since the last call. `time_s` must not decrease.
    std::int64_t reached(double time_s) {
        double const multiple = period_s_ > 0.0 ? time_s / period_s_ + kWholeTolerance : 0.0;
        if (multiple < static_cast<double>(next_)) {
            return 0;
        }
        std::int64_t const before = next_;
        next_ = static_cast<std::int64_t>(multiple) + 1;
        return next_ - before;
    }

private:
    double period_s_;
    std::int64_t next_;
};

}  // namespace pogosim
