// What the machinery of a process says of the code that it watches over, in its messages. The room that calls user code
// knows which of its functions runs, and for which robot.
#pragma once

#include <functional>
#include <string>

#include "process/signal_text.hpp"

namespace pogosim {

using PlaceText = SignalText<512>;

class RunningCode {
public:
    virtual ~RunningCode() = default;

    // The following are about the thread that calls. They are for signal handlers: user code may have corrupted any
    // memory, so each look at it can be the last.

    /// Whether user code runs, or ran before.
    virtual bool is_known() const = 0;

    /// "user_step, tick 10, t = 0.1600 s", with as few looks at memory as possible.
    virtual PlaceText stage() const = 0;

    /// "user_step of robot #1 of category 'robots', tick 10, t = 0.1600 s".
    virtual PlaceText place() const = 0;

    /// "run it again with -s 1 --set simulation_time=0.15": the same run, ended after the previous step.
    virtual SignalText<256> how_to_repeat() const = 0;

    /// True at the places where programs for the robots' SDK have their endless loop.
    virtual bool is_at_start() const = 0;

    // The following are for a thread that watches others.

    /// What place_of() needs to know of the thread that calls.
    virtual void const* of_this_thread() const = 0;

    /// Where the code of another thread is, with file and line; empty if it has gone on, which `is_there` tells after
    /// all was read that changes then. `code`: the place in the program; null: unknown.
    virtual std::string place_of(void const* thread, void const* code, std::function<bool()> const& is_there) const = 0;
};

}  // namespace pogosim
