// What the user has asked of the run. Panels show it at once, also before the run has answered.
#pragma once

#include <string>

#include "view/exchange.hpp"

namespace pogosim {

class RunRequests {
public:
    /// `at_start`: how the run begins.
    RunRequests(Exchange& exchange, RunStatus at_start) : exchange_(exchange), status_(std::move(at_start)) {}

    /// The last status of the run, with the pause and the speed that the user has asked for since.
    RunStatus const& status() const { return status_; }

    /// Takes the status that came with a moment.
    void take(RunStatus const& newest);

    /// Asks the run for something. Returns why it cannot do it; empty: it has been asked.
    std::string send(Command const& command);

    /// Asks for `factor` times the present speed. Where there is no limit: a slower one is `factor` times the speed
    /// that the run has reached, and a faster one changes nothing.
    void change_speed(double factor);

private:
    Exchange& exchange_;
    RunStatus status_;
};

}  // namespace pogosim
