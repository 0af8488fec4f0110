// Timers that send signals to one thread.
#pragma once

#include <csignal>
#include <ctime>

namespace pogosim {

enum class TimerClock {
    processor,  // time for which the thread uses a processor
    wall,
};

/// Belongs to the thread that calls arm() or prepare() first. Children of fork() and programs started with exec() do
/// not inherit it.
/// On systems without such timers, each process has one of each kind.
class ThreadTimer {
public:
    /// The handler of `signal` finds `owner` in siginfo_t::si_value.
    ThreadTimer(TimerClock clock, int signal, void* owner) : clock_(clock), signal_(signal), owner_(owner) {}
    ~ThreadTimer() { remove(); }
    ThreadTimer(ThreadTimer const&) = delete;
    ThreadTimer& operator=(ThreadTimer const&) = delete;

    /// From now on a signal each `period_s`. For signal handlers, too, once it was armed or prepared.
    void arm(double period_s);

    /// Does the part of arm() that is not allowed in a signal handler, without starting the timer.
    void prepare();

    /// Stops it until it is armed again.
    void disarm();

    /// No signal comes after this.
    void remove();

    /// In a child of fork(), which has not inherited it.
    void forget() { exists_ = is_armed_ = false; }

    bool is_armed() const { return is_armed_; }

private:
    TimerClock clock_;
    int signal_;
    void* owner_;
    bool exists_ = false;
    bool is_armed_ = false;
#ifdef __linux__
    timer_t timer_{};
#endif
};

/// Whether timers of one thread may stay while another one has its own.
#ifdef __linux__
inline constexpr bool kTimersStay = true;
#else
inline constexpr bool kTimersStay = false;
#endif

/// Those of the watch over user code. Their signals have the address of this in siginfo_t::si_value.
struct ThreadTimers {
    ThreadTimers() = default;
    ~ThreadTimers() = default;
    ThreadTimers(ThreadTimers const&) = delete;
    ThreadTimers& operator=(ThreadTimers const&) = delete;

    ThreadTimer processor{TimerClock::processor, SIGPROF, this};
    ThreadTimer wall{TimerClock::wall, SIGALRM, this};
};

}  // namespace pogosim
