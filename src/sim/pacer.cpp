#include "sim/pacer.hpp"

#include <algorithm>

namespace pogosim {

namespace {

using Seconds = std::chrono::duration<double>;

constexpr Seconds kMostLate{0.1};
constexpr Seconds kLongestWait{1e8};  // three years; a clock does not hold much more
constexpr Seconds kMeasured{0.5};
constexpr double kKept = 0.9;  // of the asked speed

}  // namespace

void Pacer::set_speed_up(double speed_up) {
    speed_up_ = speed_up;
    start_anew();
}

void Pacer::start_anew() {
    start_.reset();
    measured_.reset();
    reached_ = 0.0;
}

Pacer::Clock::time_point Pacer::due(double time_s, double step_s, Clock::time_point now) {
    if (speed_up_ <= 0.0) {
        return now;
    }
    if (!start_) {
        start_ = Mark{now, time_s};
        measured_.reset();
    }
    double const end_s = time_s + step_s;
    auto const due = start_->wall + std::chrono::duration_cast<Clock::duration>(
                                        std::min(Seconds((end_s - start_->time_s) / speed_up_), kLongestWait));
    if (now - due > kMostLate) {
        start_ = Mark{now, end_s};
        return now;
    }
    return due;
}

void Pacer::note_step(double time_s, Clock::time_point now) {
    if (!measured_) {
        measured_ = Mark{now, time_s};
        return;
    }
    Seconds const elapsed = now - measured_->wall;
    if (elapsed >= kMeasured) {
        reached_ = (time_s - measured_->time_s) / elapsed.count();
        measured_ = Mark{now, time_s};
    }
}

bool Pacer::is_too_slow() const {
    return speed_up_ > 0.0 && reached_ > 0.0 && reached_ < kKept * speed_up_;
}

}  // namespace pogosim
