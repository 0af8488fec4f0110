#include "process/thread_timer.hpp"

#ifdef __linux__
#include <sys/syscall.h>
#include <unistd.h>

#include <cmath>
#endif

namespace pogosim {

#ifdef __linux__

// Older versions of the C library have the member, and not this name of it.
#ifndef sigev_notify_thread_id
#define sigev_notify_thread_id _sigev_un._tid
#endif

ThreadTimer::ThreadTimer(TimerClock clock, int signal, void* owner) : clock_(clock), signal_(signal), owner_(owner) {}

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

void ThreadTimer::forget() {
    exists_ = is_armed_ = false;
}

bool is_of_timer(ThreadTimers const* timers, siginfo_t const& info) {
    return timers != nullptr && info.si_code == SI_TIMER && info.si_value.sival_ptr == timers;
}

#else

ThreadTimer::ThreadTimer(TimerClock clock, int signal, void* /*owner*/) : clock_(clock), signal_(signal) {}

void ThreadTimer::prepare() {
    if (timer_ == nullptr) {
        timer_ = std::make_unique<SentTimer>(clock_, signal_);
    }
}

void ThreadTimer::arm(double period_s) {
    prepare();
    is_armed_ = true;
    timer_->start(period_s);
}

void ThreadTimer::disarm() {
    if (is_armed_) {
        timer_->stop();
        is_armed_ = false;
    }
}

void ThreadTimer::remove() {
    forget();
}

void ThreadTimer::forget() {
    timer_.reset();
    is_armed_ = false;
}

bool is_of_timer(ThreadTimers const* /*timers*/, siginfo_t const& /*info*/) {
    return false;
}

#endif

}  // namespace pogosim
