// States of the run in the last seconds, so that the run itself can go on from one of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>

#include "sim/saved_state.hpp"

namespace pogosim {

class Simulation;

class StateHistory {
public:
    /// States of so much simulated time are kept.
    explicit StateHistory(double longest_s) : longest_s_(longest_s) {}

    static constexpr std::size_t kMostBytes = std::size_t{256} << 20U;  // of all states, but one is kept in any case

    /// Call it after each step: keeps the state if that is due, every thirtieth of the time. In a run whose state
    /// cannot be copied, none is kept, and why_no_way_back() says why.
    void keep_if_due(Simulation& simulation);

    std::string const& why_no_way_back() const { return why_no_way_back_; }

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
        std::size_t bytes = 0;
    };

    double longest_s_;
    std::deque<Kept> kept_;  // in the order of time
    std::size_t bytes_ = 0;  // of all
    std::string why_no_way_back_;
};

}  // namespace pogosim
