#include "view/shown_moment.hpp"

#include <algorithm>

namespace pogosim {

namespace {

constexpr double kTrailPeriodS = 0.1;  // of simulated time

}  // namespace

void ShownMoment::take(Moment const& newest, bool shows_trails) {
    newest_ = std::make_unique<Moment>(newest);
    history_.add(newest);
    Snapshot& snapshot = newest_->snapshot;
    if (snapshot.trails != nullptr || !shows_trails) {
        trails_ = snapshot.trails;
        trails_time_s_ = snapshot.time_s;
    }
    snapshot.trails = trails_;
}

bool ShownMoment::has_fresh_trails() const {
    double const time_s = newest_ != nullptr ? newest_->snapshot.time_s : 0.0;
    return trails_ != nullptr && time_s - trails_time_s_ < kTrailPeriodS;
}

bool ShownMoment::look_at(double time_s) {
    time_s_.reset();
    if (!history_.empty() && time_s < history_.last_s()) {
        time_s_ = std::max(time_s, history_.first_s());
    }
    return time_s_.has_value();
}

bool ShownMoment::look_at_neighbour(int direction) {
    return !history_.empty() && look_at(history_.neighbour_s(time_s_.value_or(history_.last_s()), direction));
}

void ShownMoment::choose() {
    past_ = time_s_ ? history_.at(*time_s_) : nullptr;
}

}  // namespace pogosim
