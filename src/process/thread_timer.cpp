#include "process/thread_timer.hpp"

#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#include <cmath>
#include <csignal>

namespace pogosim {

#ifdef __linux__

// Older versions of the C library have the member, and not this name of it.
#ifndef sigev_notify_thread_id
#define sigev_notify_thread_id _sigev_un._tid
#endif

void ThreadTimer::prepare() {
    if (exists_) {
        return;
    }
    sigevent event = {};
    event.sigev_notify = SIGEV_THREAD_ID;
    event.sigev_signo = signal_;
    event.sigev_value.sival_ptr = owner_;
    event.sigev_notify_thread_id = static_cast<pid_t>(syscall(SYS_gettid));
    exists_ =
        timer_create(clock_ == TimerClock::processor ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, &event, &timer_) == 0;
}

void ThreadTimer::arm(double period_s) {
    prepare();
    if (!exists_) {
        return;
    }
    constexpr double ns_per_s = 1e9;
    itimerspec times = {};
    times.it_interval.tv_sec = static_cast<time_t>(period_s);
    times.it_interval.tv_nsec = static_cast<long>((period_s - std::floor(period_s)) * ns_per_s);
    times.it_value = times.it_interval;
    is_armed_ = true;
    timer_settime(timer_, 0, &times, nullptr);
}

void ThreadTimer::disarm() {
    if (is_armed_) {
        itimerspec const none = {};
        timer_settime(timer_, 0, &none, nullptr);
        is_armed_ = false;
    }
}

void ThreadTimer::remove() {
    if (exists_) {
        timer_delete(timer_);
    }
    exists_ = is_armed_ = false;
}

#else

void ThreadTimer::prepare() {}

void ThreadTimer::arm(double period_s) {
    constexpr double us_per_s = 1e6;
    itimerval times = {};
    times.it_interval.tv_sec = static_cast<time_t>(period_s);
    times.it_interval.tv_usec = static_cast<suseconds_t>((period_s - std::floor(period_s)) * us_per_s);
    times.it_value = times.it_interval;
    setitimer(clock_ == TimerClock::processor ? ITIMER_PROF : ITIMER_REAL, &times, nullptr);
    exists_ = is_armed_ = true;
}

void ThreadTimer::disarm() {
    remove();
}

void ThreadTimer::remove() {
    if (exists_) {
        itimerval const none = {};
        setitimer(clock_ == TimerClock::processor ? ITIMER_PROF : ITIMER_REAL, &none, nullptr);
    }
    exists_ = is_armed_ = false;
}

#endif

}  // namespace pogosim
