// The watch over user code that does not return: by the processor time of its thread (SIGPROF), which a program on a
// busy machine does not use up by waiting; and, once the run was asked to end, by wall-clock time (SIGALRM), which runs
// in sleep(), too. After user code was left by force, SIGALRM watches over the data file alone.
#include <pthread.h>

#include <algorithm>
#include <csignal>
#include <ctime>

#include "base/save_progress.hpp"
#include "robot/caught_signals.hpp"
#include "robot/context.hpp"
#include "robot/guard_state.hpp"
#include "robot/last_words.hpp"
#include "robot/user_guard.hpp"

namespace pogosim {

namespace {

constexpr double kWatchPeriodS = 0.25;   // of processor time
constexpr double kRetryPeriodS = 0.001;  // in which user code is looked for outside of libraries
constexpr double kLongestRetryS = 0.25;
constexpr double kLookPeriodS = 0.05;   // of wall-clock time
constexpr double kPromptReturnS = 0.1;  // shorter waits are not reported
constexpr double kPromptEndS = 1.0;     // of a step of the simulator's own, and of the data file
constexpr double kPatienceS = 10.0;     // for user code without a limit, and for the simulator's own
constexpr double kRescueLookPeriodS = 0.25;
constexpr double kSlowestDiskBytesPerS = 1e7;

/// A program for the SDK alone has its endless loop where the robot starts, which pogobot.h makes possible.
bool is_at_robots_start() {
    return context.phase == Phase::user_init || (context.phase == Phase::main && context.waiting == Waiting::never);
}

constexpr auto kMoveTheLoop =
    ": move the body of its endless loop into user_step, or include pogobot.h alone (see docs/porting.md)";
constexpr auto kLetTimePass =
    "; while it runs, time passes only as it sleeps, or reads its clock, sensors or messages again and again";

double thread_processor_time_s() {
    timespec now = {};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

/// The run whose timer has sent this signal to this thread; null: it is not from one of them.
RunGuard* run_of(siginfo_t const& info) {
    RunGuard* const guard = active_guard;
    bool const is_timers = info.si_code != SI_TIMER || info.si_value.sival_ptr == guard;  // or sent by hurry()
    return guard != nullptr && is_timers ? guard : nullptr;
}

void on_watch(int signal, siginfo_t* info, void* signal_context) {
    RunGuard* const run = run_of(*info);
    if (run == nullptr) {
        pass_on(signal, info, signal_context);
        return;
    }
    RunGuard& guard = *run;
    ProcessorWatch& busy = guard.busy;
    double const now_s = thread_processor_time_s();
    if (!guard.inside || guard.calls != busy.calls_seen) {
        busy.calls_seen = guard.calls;
        busy.seen_at_s = now_s;
        if (busy.retrying) {
            busy.retrying = false;
            guard.processor_timer.arm(busy.period_s);
        }
        return;
    }
    double const too_long_s = now_s - busy.seen_at_s - busy.timeout_s;
    if (too_long_s < 0.0) {
        return;
    }
    if (!is_in_user_program(guard, signal_context) && too_long_s < kLongestRetryS) {
        if (!busy.retrying) {
            busy.retrying = true;
            guard.processor_timer.arm(kRetryPeriodS);
        }
        return;
    }
    SignalText<512> what;
    what << "did not return within ";
    what.number(busy.timeout_s, 6, /*kept=*/false) << " s of processor time (user_code_timeout)";
    what << (is_at_robots_start() ? kMoveTheLoop : kLetTimePass);
    guard.too_long = true;
    begin_rescue(guard, what.c_str(), ExitCode::user_program, /*in_other_thread=*/false);
    note_place(guard, signal_context);
    jump_out(guard, ExitCode::user_program);
}

/// From another thread.
void hurry_thread(RunGuard& guard, char const* request_name) {
    if (guard.is_watching) {
        guard.hurry_request = request_name;
        pthread_kill(guard.thread, SIGALRM);
    }
}

bool has_busy_helper(RunGuard const& guard) {
    RunGuard const* helper = guard.helpers;
    while (helper != nullptr && !helper->inside) {
        helper = helper->next_helper;
    }
    return helper != nullptr;
}

/// Tells the waiting user what is going on, once.
void tell_what_is_waited_for(RunGuard& guard) {
    WallClockWatch& waiting = guard.waiting;
    ProcessorWatch const& busy = guard.busy;
    bool const is_others_to_tell = !guard.inside && (guard.helped != nullptr || has_busy_helper(guard));
    if (waiting.told || is_others_to_tell) {
        return;
    }
    waiting.told = true;
    SignalText<1024> text;
    text << "pogosim: " << waiting.request_name << ": stopping ";
    if (guard.inside) {
        text << "as soon as " << running_place().c_str()
             << ", returns. Send a second signal to stop now; otherwise it is aborted ";
        if (busy.timeout_s > 0.0) {
            text.number(busy.timeout_s, 6, /*kept=*/false) << " s after it began (user_code_timeout).\n";
        } else {
            text.number(kPatienceS, 0) << " s from now (there is no user_code_timeout).\n";
        }
    } else {
        text << "after this step, once the data file is complete.\n";
    }
    text.write_to_stderr();
}

/// Aborts user code as requested, where it is safe.
void look_after_request(RunGuard& guard, void const* signal_context, double now_s) {
    EndRequest const& request = guard.request;
    double const asked_since_s = now_s - request.made_s;
    if (!guard.inside) {
        // call_user_code() sees the request, unless the simulator waits for a lock that is gone.
        if (asked_since_s > kPatienceS) {
            begin_rescue(guard, request.what.c_str(), request.code, request.in_other_thread);
            give_up_rescue(guard);
        }
        return;
    }
    if (is_in_user_program(guard, signal_context) || asked_since_s > kLongestRetryS) {
        begin_rescue(guard, request.what.c_str(), request.code, request.in_other_thread);
        if (!request.in_other_thread) {
            note_place(guard, signal_context);
            guard.request.place = guard.place;
        }
        jump_out(guard, request.code);
    }
}

/// A large file, or a slow disk, takes its time.
void look_after_rescue(RunGuard& guard, double now_s) {
    RescueWatch& rescue = guard.rescue;
    SaveProgress const& progress = save_progress();
    std::uint64_t const writes = progress.writes;
    if (writes != rescue.writes_seen) {
        rescue.writes_seen = writes;
        rescue.last_write_s = now_s;
    }
    double const limit_s = kPatienceS + rescue.grace_s + static_cast<double>(progress.bytes) / kSlowestDiskBytesPerS;
    if (now_s - rescue.last_write_s > limit_s) {
        give_up_rescue(guard);
    }
}

void on_look(int signal, siginfo_t* info, void* signal_context) {
    RunGuard* const run = run_of(*info);
    if (run == nullptr) {
        pass_on(signal, info, signal_context);
        return;
    }
    RunGuard& guard = *run;
    double const now_s = monotonic_s();
    if (guard.left_by_force) {
        look_after_rescue(guard, now_s);
        return;
    }
    if (end_request(guard) != nullptr) {
        look_after_request(guard, signal_context, now_s);
        return;
    }
    if (char const* const name = guard.hurry_request.exchange(nullptr)) {
        hurry_user_code(guard, name);
        return;
    }
    WallClockWatch& waiting = guard.waiting;
    if (guard.expects_rescue) {
        look_after_rescue(guard, now_s);
        if (*waiting.request_name == '\0') {
            return;
        }
    }
    ProcessorWatch const& busy = guard.busy;
    if (guard.calls != waiting.calls_seen) {
        waiting.calls_seen = guard.calls;
        waiting.call_began_s = now_s;
        return;
    }
    if (now_s - waiting.call_began_s > (guard.inside ? kPromptReturnS : kPromptEndS)) {
        tell_what_is_waited_for(guard);
    }
    double const limit_s = busy.timeout_s > 0.0 ? busy.timeout_s : kPatienceS;
    if (guard.inside && now_s - waiting.call_began_s > limit_s) {
        SignalText<512> what;
        what << "it had not returned ";
        what.number(limit_s, 6, /*kept=*/false);
        if (busy.timeout_s > 0.0) {
            what << " s after it began (user_code_timeout), and " << waiting.request_name << " had requested a stop";
        } else {
            what << " s after " << waiting.request_name << " requested a stop";
        }
        what << (is_at_robots_start() ? kMoveTheLoop : "");
        request_end(guard, what.c_str(), ExitCode::interrupted, /*in_other_thread=*/false);
    }
}

}  // namespace

void request_end(RunGuard& guard, char const* what, ExitCode code, bool in_other_thread, void const* place) {
    RequestState expected = RequestState::none;
    if (guard.left_by_force || !guard.request_state.compare_exchange_strong(expected, RequestState::being_made)) {
        return;
    }
    EndRequest& request = guard.request;
    request.what = {};
    request.what << what;
    request.code = code;
    request.in_other_thread = in_other_thread;
    request.place = place;
    request.made_s = monotonic_s();
    guard.request_state = RequestState::made;
    guard.wall_timer.arm(kRetryPeriodS);
}

void drop_end_request(RunGuard& guard) {
    guard.request_state = RequestState::none;
}

EndRequest const* end_request(RunGuard const& guard) {
    return guard.request_state.load(std::memory_order_acquire) == RequestState::made ? &guard.request : nullptr;
}

void catch_watch_signals() {
    catch_signal(SIGALRM, SA_RESTART, on_look);
    catch_signal(SIGPROF, SA_RESTART, on_watch);
}

void give_back_watch_signals() {
    give_back_signal(SIGALRM);
    give_back_signal(SIGPROF);
}

void start_watch(RunGuard& guard) {
    guard.is_watching = true;
    guard.wall_timer.prepare();
    if (guard.left_by_force) {
        watch_rescue(guard);
    }
    if (double const timeout_s = guard.busy.timeout_s; timeout_s > 0.0) {
        guard.busy.calls_seen = 0;
        guard.busy.retrying = false;
        guard.busy.period_s = std::max(kRetryPeriodS, std::min(kWatchPeriodS, timeout_s / 4.0));
        guard.processor_timer.arm(guard.busy.period_s);
    }
}

void watch_rescue(RunGuard& guard, double grace_s) {
    guard.rescue = {.writes_seen = save_progress().writes, .last_write_s = monotonic_s(), .grace_s = grace_s};
    catch_signal(SIGALRM, SA_RESTART, on_look);  // the program may have taken it
    guard.wall_timer.arm(kRescueLookPeriodS);
}

void stop_watch(RunGuard& guard) {
    guard.is_watching = false;
    guard.processor_timer.remove();
    guard.wall_timer.remove();
}

void hurry_user_code(RunGuard& guard, char const* request_name) {
    if (guard.left_by_force || !guard.is_watching) {
        return;  // the timer watches over the data file, or the run is over: nothing would stop it
    }
    double const now_s = monotonic_s();
    double const entered_s = guard.entered_s.load(std::memory_order_relaxed);
    bool const has_limit = guard.busy.timeout_s > 0.0;
    guard.waiting = {.request_name = request_name,
                     .calls_seen = guard.calls,
                     .call_began_s = guard.inside && has_limit ? entered_s : now_s};
    if (guard.inside && now_s - entered_s > kPromptReturnS) {
        tell_what_is_waited_for(guard);
    }
    guard.wall_timer.arm(kLookPeriodS);
    for (RunGuard* helper = guard.helpers; helper != nullptr; helper = helper->next_helper) {
        hurry_thread(*helper, request_name);
    }
}

void UserGuard::hurry(char const* request_name) {
    hurry_thread(*state_, request_name);
}

void abandon_user_code(RunGuard& guard) {
    for (RunGuard* helper = guard.helpers; helper != nullptr; helper = helper->next_helper) {
        abandon_user_code(*helper);
    }
    if (guard.inside) {
        SignalText<512> what;
        what << "interrupted again before it returned" << (is_at_robots_start() ? kMoveTheLoop : "");
        request_end(guard, what.c_str(), ExitCode::interrupted, /*in_other_thread=*/false);
    }
}

}  // namespace pogosim
