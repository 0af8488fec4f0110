// States of the last seconds of a run, in memory, from which the window goes on when the user went back.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>

#include "sim/saved_state.hpp"

namespace pogosim {

class Simulation;

class RecentStates {
public:
    /// States of so much simulated time are kept.
    explicit RecentStates(double longest_s) : longest_s_(longest_s) {}

    /// Call it after each step: keeps the state if that is due, every thirtieth of the time. In a run whose state
    /// cannot be copied, none is kept, and why_none() says why.
    void keep_if_due(Simulation& simulation);

    std::string const& why_none() const { return why_none_; }

    /// The earliest time to which the run can go back, s; infinite: to none.
    double earliest_s() const;

    /// Takes the run back to the last state that is not after a time. False: there is none. What was after it is
    /// forgotten.
    bool go_back(Simulation& simulation, double time_s);

private:
    struct Kept {
        std::int64_t step = 0;
        double time_s = 0.0;
        std::unique_ptr<SavedState> state;
    };

    double longest_s_;
    std::deque<Kept> kept_;  // in the order of time
    std::string why_none_;
};

}  // namespace pogosim
