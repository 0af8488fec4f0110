// When something is due in a run: at the first step at or after each multiple of a period, without drift; and the times
// that rows of the data file bear.
#pragma once

#include <cstdint>
#include <optional>

#include "base/state_bytes.hpp"
#include "config/scenario.hpp"
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

/// As the original simulator does it: it sums its time steps in single precision, records at the end of a step, under
/// the time at which that step began, and counts the next period from there. With 10 ms and 1 s, the rows are those of
/// 0, 1.01, 2.02, 3.03 s, ...
class OriginalRowTimes {
public:
    explicit OriginalRowTimes(double period_s) : period_s_(static_cast<float>(period_s)) {}

    /// To be called before the first step and after each one. The time of the rows, if they are due.
    std::optional<double> due(World const& world) {
        if (world.step == 0) {
            return 0.0;
        }
        float const now_s = began_s_;
        began_s_ += static_cast<float>(world.time_step_s);
        if (period_s_ <= 0.0F || now_s < last_s_ + period_s_) {
            return std::nullopt;
        }
        last_s_ = now_s;
        return now_s;
    }

    /// See state_bytes.hpp.
    template <class Self, class State>
    static void visit_state(Self& self, State& state) {
        state(self.began_s_, self.last_s_);
    }

private:
    float period_s_;
    float began_s_ = 0.0F;  // of the next step
    float last_s_ = 0.0F;   // of the last rows
};

class RowTimes {
public:
    RowTimes(RowTiming timing, double period_s) : multiples_(period_s, /*first=*/0) {
        if (timing == RowTiming::original) {
            original_.emplace(period_s);
        }
    }

    /// The same, for either of them.
    std::optional<double> due(World const& world) {
        if (original_) {
            return original_->due(world);
        }
        return multiples_.reached(world.time_s()) > 0 ? std::optional(world.time_s()) : std::nullopt;
    }

    void append_state(StateWriter& state) const {
        state(original_.has_value());
        if (original_) {
            state(*original_);
        }
    }

    /// Goes on behind the rows of the run that was saved; the period may be another one. Throws ForeignState.
    void take_state(StateReader& state, World const& world) {
        bool was_original = false;
        state(was_original);
        if (was_original) {
            OriginalRowTimes saved = original_.value_or(OriginalRowTimes(0.0));
            state(saved);
            original_ = original_ ? std::optional(saved) : std::nullopt;
        }
        multiples_.reached(world.time_s());
    }

private:
    Multiples multiples_;
    std::optional<OriginalRowTimes> original_;
};

}  // namespace pogosim
