// Timers that send signals to one thread.
#pragma once

#include <csignal>

#ifdef __linux__
#include <ctime>
#else
#include <memory>

#include "process/sent_timer.hpp"
#endif

#include "process/timer_clock.hpp"

namespace pogosim {

/// Belongs to the thread that calls arm() or prepare() first. Children of fork() and programs started with exec() do
/// not inherit it.
class ThreadTimer {
public:
    /// The handler of `signal` finds `owner` in siginfo_t::si_value, see is_of_timer().
    ThreadTimer(TimerClock clock, int signal, void* owner);
    ~ThreadTimer() { remove(); }
    ThreadTimer(ThreadTimer const&) = delete;
    ThreadTimer& operator=(ThreadTimer const&) = delete;

    /// From now on a signal each `period_s`. For signal handlers, too, once it was armed or prepared.
    void arm(double period_s);

    /// Does the part of arm() that is not allowed in a signal handler, without starting the timer.
    void prepare();

    /// Stops it until it is armed again.
    void disarm();

    /// It sends no signal after this. One that it sent before may still be on its way.
    void remove();

    /// In a child of fork(), which has not inherited it.
    void forget();

    bool is_armed() const { return is_armed_; }

private:
    TimerClock clock_;
    int signal_;
    bool is_armed_ = false;
#ifdef __linux__
    void* owner_;
    bool exists_ = false;
    timer_t timer_{};
#else
    std::unique_ptr<SentTimer> timer_;
#endif
};

/// Those of the watch over user code.
struct ThreadTimers {
    ThreadTimers() = default;
    ~ThreadTimers() = default;
    ThreadTimers(ThreadTimers const&) = delete;
    ThreadTimers& operator=(ThreadTimers const&) = delete;

    ThreadTimer processor{TimerClock::processor, SIGPROF, this};
    ThreadTimer wall{TimerClock::wall, SIGALRM, this};
};

/// For handlers: whether a signal is from one of these timers of the system. Where it has none, signals are sent: see
/// take_sent_signal().
bool is_of_timer(ThreadTimers const* timers, siginfo_t const& info);

}  // namespace pogosim
