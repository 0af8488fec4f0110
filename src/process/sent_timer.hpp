// Timers for systems that have none of a thread's own (macOS): a thread of the simulator looks at the clock, and sends
// the signals.
#pragma once

#include <cstdint>
#include <memory>

#include "process/timer_clock.hpp"

namespace pogosim {

/// Belongs to the thread that makes it; its signals are those of sent_signals.hpp. In a child of fork() it does
/// nothing.
class SentTimer {
public:
    SentTimer(TimerClock clock, int signal);
    ~SentTimer();
    SentTimer(SentTimer const&) = delete;
    SentTimer& operator=(SentTimer const&) = delete;

    /// From now on a signal each `period_s`. For signal handlers, too.
    void start(double period_s);

    /// Stops it until it is started again. For signal handlers, too.
    void stop();

    struct Entry;

private:
    std::shared_ptr<Entry> entry_;
};

}  // namespace pogosim
