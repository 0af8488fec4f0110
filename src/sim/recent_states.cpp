#include "sim/recent_states.hpp"

#include <limits>
#include <utility>

#include "base/error.hpp"
#include "sim/simulation.hpp"

namespace pogosim {

namespace {

constexpr double kStates = 30.0;

}  // namespace

void RecentStates::keep_if_due(Simulation& simulation) {
    World const& world = simulation.world();
    bool const is_due = kept_.empty() || world.time_s() - kept_.back().time_s >= longest_s_ / kStates;
    if (longest_s_ <= 0.0 || !why_none_.empty() || !is_due) {
        return;
    }
    why_none_ = simulation.why_not_saved();
    if (!why_none_.empty()) {
        return;
    }
    try {
        kept_.push_back({.step = world.step, .time_s = world.time_s(), .state = simulation.save()});
    } catch (ConfigError const& error) {
        why_none_ = error.what();
        kept_.clear();
        return;
    }
    while (kept_.back().time_s - kept_.front().time_s > longest_s_) {
        kept_.pop_front();
    }
}

double RecentStates::earliest_s() const {
    return kept_.empty() ? std::numeric_limits<double>::infinity() : kept_.front().time_s;
}

bool RecentStates::go_back(Simulation& simulation, double time_s) {
    double const latest_s = time_s + 0.5 * simulation.world().time_step_s;
    if (earliest_s() > latest_s) {
        return false;
    }
    while (kept_.back().time_s > latest_s) {
        kept_.pop_back();
    }
    simulation.restore(*kept_.back().state);
    return true;
}

}  // namespace pogosim
