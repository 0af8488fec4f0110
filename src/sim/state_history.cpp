#include "sim/state_history.hpp"

#include <limits>
#include <utility>

#include "base/error.hpp"
#include "sim/simulation.hpp"

namespace pogosim {

namespace {

constexpr double kStates = 30.0;

}  // namespace

void StateHistory::keep_if_due(Simulation& simulation) {
    World const& world = simulation.world();
    bool const is_due = kept_.empty() || world.time_s() - kept_.back().time_s >= longest_s_ / kStates;
    if (longest_s_ <= 0.0 || !why_no_way_back_.empty() || !is_due) {
        return;
    }
    why_no_way_back_ = simulation.why_not_saved();
    if (!why_no_way_back_.empty()) {
        return;
    }
    try {
        auto state = simulation.save();
        std::size_t const bytes = bytes_of(*state);
        kept_.push_back({.step = world.step, .time_s = world.time_s(), .state = std::move(state), .bytes = bytes});
        bytes_ += bytes;
    } catch (ConfigError const& error) {
        why_no_way_back_ = error.what();
        kept_.clear();
        bytes_ = 0;
        return;
    }
    while (kept_.size() > 1 && (kept_.back().time_s - kept_.front().time_s > longest_s_ || bytes_ > kMostBytes)) {
        bytes_ -= kept_.front().bytes;
        kept_.pop_front();
    }
}

double StateHistory::earliest_s() const {
    return kept_.empty() ? std::numeric_limits<double>::infinity() : kept_.front().time_s;
}

bool StateHistory::go_back(Simulation& simulation, double time_s) {
    double const latest_s = time_s + 0.5 * simulation.world().time_step_s;
    if (earliest_s() > latest_s) {
        return false;
    }
    while (kept_.back().time_s > latest_s) {
        bytes_ -= kept_.back().bytes;
        kept_.pop_back();
    }
    simulation.restore(*kept_.back().state);
    return true;
}

}  // namespace pogosim
