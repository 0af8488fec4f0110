#include "process/signals_of_runs.hpp"

#include <chrono>
#include <memory>
#include <mutex>

#include "process/crash_handler_state.hpp"
#include "process/other_threads.hpp"
#include "process/process.hpp"

namespace pogosim {

constinit thread_local ThreadTimers* timers_of_thread = nullptr;

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kCheckPeriod{2};  // in which handlers of the host's own are looked for again
constexpr int kLooksToGiveBack = 2;

struct State {
    std::mutex mutex;  // of what follows
    int needs = 0;
    bool are_caught = false;
    Clock::time_point checked_at{};
    int idle_looks = 0;  // since the last need
};

/// Never destroyed: threads may outlive it.
State& state() {
    static State& only = *new State;
    return only;
}

void give_back(State& now) {
    if (now.are_caught) {
        give_back_signals_of_runs();
        now.are_caught = false;
    }
}

/// Timers that a thread of a host keeps from run to run.
class KeptTimers {
public:
    KeptTimers() { timers_of_thread = &timers_; }
    ~KeptTimers() { timers_of_thread = nullptr; }
    KeptTimers(KeptTimers const&) = delete;
    KeptTimers& operator=(KeptTimers const&) = delete;

private:
    ThreadTimers timers_;
};

constinit thread_local int depth = 0;

void keep_timers() {
    static thread_local std::unique_ptr<KeptTimers> kept;
    static constinit thread_local bool were_made = false;  // after the thread's end, runs have timers of their own
    if (!were_made) {
        were_made = true;
        kept = std::make_unique<KeptTimers>();
    }
}

}  // namespace

void need_signals() {
    State& now = state();
    std::lock_guard const lock(now.mutex);
    now.idle_looks = 0;
    if (now.needs++ > 0) {
        return;
    }
    auto const time = Clock::now();
    if (!now.are_caught || time - now.checked_at > kCheckPeriod || !signals_of_runs_are_caught()) {
        catch_signals_of_runs();
        now.are_caught = true;
        now.checked_at = time;
    }
}

void need_signals_no_more() {
    // The thread of the watch gives them back. A host that has handlers of its own for alarms gets them at once: ours
    // would let its system calls go on (SA_RESTART), which an alarm is to interrupt.
    bool const is_watched = watches_over_blocked();
    State& now = state();
    std::lock_guard const lock(now.mutex);
    if (--now.needs == 0 && (!is_watched || host_handles_watch_signals())) {
        give_back(now);
    }
}

void find_watch_signals_again() {
    std::lock_guard const lock(state().mutex);
    catch_watch_signals();
}

void let_go_of_signals() {
    State& now = state();
    std::lock_guard const lock(now.mutex);
    if (now.needs > 0 || !now.are_caught) {
        return;
    }
    if (++now.idle_looks > kLooksToGiveBack) {
        give_back(now);
    }
}

void hold_signals_before_fork() {
    state().mutex.lock();
}

void release_signals_in_parent() {
    state().mutex.unlock();
}

void forget_signals_in_child() {
    State& now = state();
    if (timers_of_thread != nullptr) {
        timers_of_thread->processor.forget();
        timers_of_thread->wall.forget();
    }
    if (!process_is_ours() && active_handler == nullptr) {
        now.needs = 0;  // of threads that are not there
        give_back(now);
    }
    now.mutex.unlock();
}

ThreadOfRuns::ThreadOfRuns() {
    if (depth++ > 0) {
        return;
    }
    use_large_signal_stack();
    if (!process_is_ours()) {
        keep_timers();
    }
    need_signals();
}

ThreadOfRuns::~ThreadOfRuns() {
    if (--depth == 0) {
        need_signals_no_more();
    }
}

}  // namespace pogosim
