// The watch over user code that does not return. It goes by the processor time of the thread (SIGPROF), which waiting
// on a busy machine does not use up; and, once the run was asked to end, by wall-clock time (SIGALRM), which passes in
// sleep(), too. After user code was left by force, SIGALRM watches only over the data file.
#include <algorithm>
#include <csignal>
#include <ctime>

#include "base/save_progress.hpp"
#include "process/caught_signals.hpp"
#include "process/crash_handler.hpp"
#include "process/crash_handler_state.hpp"
#include "process/crash_message.hpp"
#include "process/sent_signals.hpp"

namespace pogosim {

namespace {

constexpr double kWatchPeriodS = 0.25;   // of processor time
constexpr double kShortTimeoutS = 1.0;   // the watch begins at once
constexpr double kRetryPeriodS = 0.001;  // in which user code is looked for outside of libraries
/// A loop of malloc() and free() is outside of libraries only now and then.
constexpr double kLongestRetryS = 1.0;
constexpr double kLookPeriodS = 0.05;   // of wall-clock time
constexpr double kPromptReturnS = 0.1;  // shorter waits are not reported
constexpr double kPromptEndS = 1.0;     // of a step of the simulator's own, and of the data file
constexpr double kPatienceS = 10.0;     // for user code without a limit, and for the simulator's own
constexpr double kRescueLookPeriodS = 0.25;
constexpr double kSlowestDiskBytesPerS = 1e7;

constexpr auto kMoveTheLoop =
    ": move the body of its endless loop into user_step, or include pogobot.h alone (see docs/porting.md)";
constexpr auto kLetTimePass =
    "; while it runs, time passes only as it sleeps, or reads its clock, sensors or messages again and again";

double thread_processor_time_s() {
    timespec now = {};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

/// The run that a signal is for: one of its timers has sent it, or hurry_thread() has. Null: there is none; a signal of
/// others, such as an alarm of the host, has been passed on.
CrashHandlerState* run_of(int signal, siginfo_t* info, void* signal_context) {
    if (!is_signalled_thread()) {
        pass_on(signal, info, signal_context);
        return nullptr;
    }
    CrashHandlerState* const handler = active_handler;
    ThreadTimers const* const timers = handler != nullptr ? handler->timers : timers_of_thread;
    if (take_sent_signal(signal) || is_of_timer(timers, *info)) {
        return handler;
    }
    // Timers of a host's thread may go on between its runs.
    if (!is_of_timer(timers_of_thread, *info)) {
        pass_on(signal, info, signal_context);
    }
    return nullptr;
}

void on_watch(int signal, siginfo_t* info, void* signal_context) {
    CrashHandlerState* const run = run_of(signal, info, signal_context);
    if (run == nullptr) {
        return;
    }
    CrashHandlerState& handler = *run;
    ProcessorWatch& busy = handler.busy;
    double const now_s = thread_processor_time_s();
    if (!handler.inside || handler.calls != busy.calls_seen) {
        busy.calls_seen = handler.calls;
        busy.seen_at_s = now_s;
        if (busy.retrying) {
            busy.retrying = false;
            handler.timers->processor.arm(busy.period_s);
        }
        return;
    }
    double const too_long_s = now_s - busy.seen_at_s - busy.timeout_s;
    if (too_long_s < 0.0) {
        return;
    }
    if (!is_in_user_program(handler, signal_context) && too_long_s < kLongestRetryS) {
        if (!busy.retrying) {
            busy.retrying = true;
            handler.timers->processor.arm(kRetryPeriodS);
        }
        return;
    }
    SignalText<512> what;
    what << "did not return within ";
    what.number(busy.timeout_s, 6, /*kept=*/false) << " s of processor time (user_code_timeout)";
    what << (handler.running.is_at_start() ? kMoveTheLoop : kLetTimePass);
    handler.too_long = true;
    begin_rescue(handler, what.c_str(), ExitCode::user_program, /*in_other_thread=*/false);
    note_place(handler, signal_context);
    jump_out(handler, ExitCode::user_program);
}

/// From another thread.
void hurry_thread(CrashHandlerState& handler, char const* request_name) {
    if (handler.is_watching) {
        handler.hurry_request = request_name;
        handler.thread.send(SIGALRM);
    }
}

bool has_busy_helper(CrashHandlerState const& handler) {
    CrashHandlerState const* helper = handler.helpers;
    while (helper != nullptr && !helper->inside) {
        helper = helper->next_helper;
    }
    return helper != nullptr;
}

/// Prints once what the run is waiting for.
void tell_what_is_waited_for(CrashHandlerState& handler) {
    WallClockWatch& waiting = handler.waiting;
    ProcessorWatch const& busy = handler.busy;
    bool const is_others_to_tell = !handler.inside && (handler.helped != nullptr || has_busy_helper(handler));
    if (waiting.told || is_others_to_tell) {
        return;
    }
    waiting.told = true;
    SignalText<1024> text;
    text << "pogosim: " << waiting.request_name << ": stopping ";
    if (handler.inside) {
        text << "as soon as " << handler.running.place().c_str()
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
void look_after_request(CrashHandlerState& handler, void const* signal_context, double now_s) {
    EndRequest const& request = handler.request;
    double const asked_since_s = now_s - request.made_s;
    if (!handler.inside) {
        // call_user_code() sees the request, unless the simulator waits for a lock that is gone.
        if (asked_since_s > kPatienceS) {
            begin_rescue(handler, request.what.c_str(), request.code, request.in_other_thread);
            give_up_rescue(handler);
        }
        return;
    }
    if (is_in_user_program(handler, signal_context) || asked_since_s > kLongestRetryS) {
        begin_rescue(handler, request.what.c_str(), request.code, request.in_other_thread);
        if (!request.in_other_thread) {
            note_place(handler, signal_context);
            handler.request.place = handler.place;
        }
        jump_out(handler, request.code);
    }
}

/// Large files and slow disks take long.
void look_after_rescue(CrashHandlerState& handler, double now_s) {
    RescueWatch& rescue = handler.rescue;
    SaveProgress const& progress = save_progress();
    std::uint64_t const writes = progress.writes;
    if (writes != rescue.writes_seen) {
        rescue.writes_seen = writes;
        rescue.last_write_s = now_s;
    }
    double const limit_s = kPatienceS + rescue.grace_s + static_cast<double>(progress.bytes) / kSlowestDiskBytesPerS;
    if (now_s - rescue.last_write_s > limit_s) {
        give_up_rescue(handler);
    }
}

void on_look(int signal, siginfo_t* info, void* signal_context) {
    CrashHandlerState* const run = run_of(signal, info, signal_context);
    if (run == nullptr) {
        return;
    }
    CrashHandlerState& handler = *run;
    double const now_s = monotonic_s();
    if (handler.left_by_force) {
        look_after_rescue(handler, now_s);
        return;
    }
    if (end_request(handler) != nullptr) {
        look_after_request(handler, signal_context, now_s);
        return;
    }
    if (char const* const name = handler.hurry_request.exchange(nullptr)) {
        hurry_user_code(handler, name);
        return;
    }
    WallClockWatch& waiting = handler.waiting;
    if (handler.expects_rescue) {
        look_after_rescue(handler, now_s);
        if (*waiting.request_name == '\0') {
            return;
        }
    }
    ProcessorWatch const& busy = handler.busy;
    if (handler.calls != waiting.calls_seen) {
        waiting.calls_seen = handler.calls;
        waiting.call_began_s = now_s;
        return;
    }
    if (now_s - waiting.call_began_s > (handler.inside ? kPromptReturnS : kPromptEndS)) {
        tell_what_is_waited_for(handler);
    }
    double const limit_s = busy.timeout_s > 0.0 ? busy.timeout_s : kPatienceS;
    if (handler.inside && now_s - waiting.call_began_s > limit_s) {
        SignalText<512> what;
        what << "it had not returned ";
        what.number(limit_s, 6, /*kept=*/false);
        if (busy.timeout_s > 0.0) {
            what << " s after it began (user_code_timeout), and " << waiting.request_name << " had requested a stop";
        } else {
            what << " s after " << waiting.request_name << " requested a stop";
        }
        what << (handler.running.is_at_start() ? kMoveTheLoop : "");
        request_end(handler, what.c_str(), ExitCode::interrupted, /*in_other_thread=*/false);
    }
}

}  // namespace

void request_end(CrashHandlerState& handler, char const* what, ExitCode code, bool in_other_thread, void const* place) {
    RequestState expected = RequestState::none;
    if (handler.left_by_force || !handler.request_state.compare_exchange_strong(expected, RequestState::being_made)) {
        return;
    }
    EndRequest& request = handler.request;
    request.what = {};
    request.what << what;
    request.code = code;
    request.in_other_thread = in_other_thread;
    request.place = place;
    request.made_s = monotonic_s();
    handler.request_state = RequestState::made;
    handler.timers->wall.arm(kRetryPeriodS);
}

void drop_end_request(CrashHandlerState& handler) {
    handler.request_state = RequestState::none;
}

EndRequest const* end_request(CrashHandlerState const& handler) {
    return handler.request_state.load(std::memory_order_acquire) == RequestState::made ? &handler.request : nullptr;
}

void catch_watch_signals() {
    catch_signal(SIGALRM, SA_RESTART, on_look);
    catch_signal(SIGPROF, SA_RESTART, on_watch);
}

bool host_handles_watch_signals() {
    return has_handler_before(SIGALRM) || has_handler_before(SIGPROF);
}

void give_back_watch_signals() {
    give_back_signal(SIGALRM);
    give_back_signal(SIGPROF);
}

void arm_watch(CrashHandlerState& handler) {
    ThreadTimer& timer = handler.timers->processor;
    if (handler.busy.timeout_s <= 0.0 || timer.is_armed()) {
        return;
    }
    if (handler.timers != &handler.own_timers) {
        find_watch_signals_again();
    }
    timer.arm(handler.busy.period_s);
}

void start_watch(CrashHandlerState& handler, bool is_looked_at) {
    handler.timers = timers_of_thread != nullptr ? timers_of_thread : &handler.own_timers;
    handler.is_watching = true;
    handler.timers->wall.prepare();
    if (handler.left_by_force) {
        watch_rescue(handler);
    }
    if (double const timeout_s = handler.busy.timeout_s; timeout_s > 0.0) {
        handler.busy.calls_seen = 0;
        handler.busy.retrying = false;
        handler.busy.period_s = std::max(kRetryPeriodS, std::min(kWatchPeriodS, timeout_s / 4.0));
        if (handler.timers == &handler.own_timers || !is_looked_at || timeout_s < kShortTimeoutS) {
            arm_watch(handler);
        } else {
            handler.timers->processor.prepare();
        }
    }
}

void watch_rescue(CrashHandlerState& handler, double grace_s) {
    handler.rescue = {.writes_seen = save_progress().writes, .last_write_s = monotonic_s(), .grace_s = grace_s};
    catch_signal(SIGALRM, SA_RESTART, on_look);  // the program may have taken it
    handler.timers->wall.arm(kRescueLookPeriodS);
}

void stop_watch(CrashHandlerState& handler) {
    handler.is_watching = false;
    bool const stays = handler.timers == timers_of_thread;
    if (stays) {
        handler.timers->processor.disarm();
    } else {
        handler.timers->processor.remove();
    }
    if (!stays || handler.timers->wall.is_armed()) {
        handler.timers->wall.remove();
    }
}

void hurry_user_code(CrashHandlerState& handler, char const* request_name) {
    if (handler.left_by_force || !handler.is_watching) {
        return;  // the timer watches over the data file, or the run is over: nothing would stop it
    }
    double const now_s = monotonic_s();
    double const entered_s = handler.entered_s.load(std::memory_order_relaxed);
    bool const has_limit = handler.busy.timeout_s > 0.0;
    handler.waiting = {.request_name = request_name,
                       .calls_seen = handler.calls,
                       .call_began_s = handler.inside && has_limit ? entered_s : now_s};
    if (handler.inside && now_s - entered_s > kPromptReturnS) {
        tell_what_is_waited_for(handler);
    }
    handler.timers->wall.arm(kLookPeriodS);
    for (CrashHandlerState* helper = handler.helpers; helper != nullptr; helper = helper->next_helper) {
        hurry_thread(*helper, request_name);
    }
}

void CrashHandler::hurry(char const* request_name) {
    hurry_thread(*state_, request_name);
}

void abandon_user_code(CrashHandlerState& handler) {
    for (CrashHandlerState* helper = handler.helpers; helper != nullptr; helper = helper->next_helper) {
        abandon_user_code(*helper);
    }
    if (handler.inside) {
        SignalText<512> what;
        what << "interrupted again before it returned" << (handler.running.is_at_start() ? kMoveTheLoop : "");
        request_end(handler, what.c_str(), ExitCode::interrupted, /*in_other_thread=*/false);
    }
}

}  // namespace pogosim
