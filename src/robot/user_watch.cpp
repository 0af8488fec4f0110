// The watch over user code that does not return: by the processor time of its thread (SIGPROF), which a program on a
// busy machine does not use up by waiting; and, once the run was asked to end, by wall-clock time (SIGALRM), which runs
// in sleep(), too. After user code was left by force, SIGALRM watches over the data file alone.
#include <sys/time.h>

#include <algorithm>
#include <ctime>
#include <string_view>

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

struct ProcessorWatch {
    double timeout_s = 0.0;
    double period_s = kWatchPeriodS;
    unsigned long calls_seen = 0;
    double seen_at_s = 0.0;  // processor time of the thread when the present call was first seen
    bool retrying = false;
};

/// State since a stop was requested.
struct WallClockWatch {
    char const* request_name = "";  // "SIGTERM"
    unsigned long calls_seen = 0;
    double call_began_s = 0.0;  // of the call of user code that was seen last
    bool told = false;
};

/// Over the data file, after user code was left by force.
struct RescueWatch {
    std::uint64_t writes_seen = 0;
    double last_write_s = 0.0;
};

ProcessorWatch busy;
WallClockWatch waiting;
RescueWatch rescue;

std::atomic<bool> is_watching = false;             // a run is going on
std::atomic<char const*> hurry_request = nullptr;  // of another thread: hurry_user_code() with this name

enum class RequestState { none, being_made, made };
EndRequest request;
std::atomic<RequestState> request_state = RequestState::none;

/// A program for the SDK alone has its endless loop where the robot starts.
bool is_at_robots_start() {
    std::string_view const phase = context.phase;
    return phase == "main" || phase == "user_init";
}

constexpr auto kMoveTheLoop = ": move the body of its endless loop into user_step (see docs/porting.md)";

/// `which`: ITIMER_PROF or ITIMER_REAL; 0 s stops it.
void set_timer(decltype(ITIMER_PROF) which, double period_s) {
    itimerval timer = {};
    timer.it_interval.tv_usec = static_cast<suseconds_t>(period_s * 1e6);
    timer.it_value = timer.it_interval;
    setitimer(which, &timer, nullptr);
}

double thread_processor_time_s() {
    timespec now = {};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

/// The timer counts the processor time of all threads, and so only says when to look.
void on_watch(int signal, siginfo_t* /*info*/, void* signal_context) {
    if (!is_signal_for_this_thread(signal)) {
        return;
    }
    double const now_s = thread_processor_time_s();
    if (!guard.inside || guard.calls != busy.calls_seen) {
        busy.calls_seen = guard.calls;
        busy.seen_at_s = now_s;
        if (busy.retrying) {
            busy.retrying = false;
            set_timer(ITIMER_PROF, busy.period_s);
        }
        return;
    }
    double const too_long_s = now_s - busy.seen_at_s - busy.timeout_s;
    if (too_long_s < 0.0) {
        return;
    }
    if (!is_in_user_program(signal_context) && too_long_s < kLongestRetryS) {
        if (!busy.retrying) {
            busy.retrying = true;
            set_timer(ITIMER_PROF, kRetryPeriodS);
        }
        return;
    }
    SignalText<512> what;
    what << "did not return within ";
    what.number(busy.timeout_s, 6, /*kept=*/false) << " s of processor time (user_code_timeout)";
    what << (is_at_robots_start() ? kMoveTheLoop
                                  : "; messages and sensors do not change while user code runs, so a step must not "
                                    "wait for them in a loop");
    guard.too_long = true;
    begin_rescue(what.c_str(), ExitCode::user_program, /*in_other_thread=*/false);
    jump_out(ExitCode::user_program);
}

/// Tells the waiting user what is going on, once.
void tell_what_is_waited_for() {
    if (waiting.told) {
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
void look_after_request(void const* signal_context, double now_s) {
    double const asked_since_s = now_s - request.made_s;
    if (!guard.inside) {
        // call_user_code() sees the request, unless the simulator waits for a lock that is gone.
        if (asked_since_s > kPatienceS) {
            begin_rescue(request.what.c_str(), request.code, request.in_other_thread);
            give_up_rescue();
        }
        return;
    }
    if (is_in_user_program(signal_context) || asked_since_s > kLongestRetryS) {
        begin_rescue(request.what.c_str(), request.code, request.in_other_thread);
        jump_out(request.code);
    }
}

/// A large file, or a slow disk, takes its time.
void look_after_rescue(double now_s) {
    SaveProgress const& progress = save_progress();
    std::uint64_t const writes = progress.writes;
    if (writes != rescue.writes_seen) {
        rescue.writes_seen = writes;
        rescue.last_write_s = now_s;
    }
    double const limit_s = kPatienceS + static_cast<double>(progress.bytes) / kSlowestDiskBytesPerS;
    if (now_s - rescue.last_write_s > limit_s) {
        give_up_rescue();
    }
}

void on_look(int signal, siginfo_t* /*info*/, void* signal_context) {
    double const now_s = monotonic_s();
    if (guard.left_by_force) {
        look_after_rescue(now_s);
        return;
    }
    if (!is_signal_for_this_thread(signal)) {
        return;
    }
    if (end_request() != nullptr) {
        look_after_request(signal_context, now_s);
        return;
    }
    if (char const* const name = hurry_request.exchange(nullptr)) {
        hurry_user_code(name);
        return;
    }
    if (guard.calls != waiting.calls_seen) {
        waiting.calls_seen = guard.calls;
        waiting.call_began_s = now_s;
        return;
    }
    if (now_s - waiting.call_began_s > (guard.inside ? kPromptReturnS : kPromptEndS)) {
        tell_what_is_waited_for();
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
        request_end(what.c_str(), ExitCode::interrupted, /*in_other_thread=*/false);
    }
}

}  // namespace

void request_end(char const* what, ExitCode code, bool in_other_thread) {
    RequestState expected = RequestState::none;
    if (guard.left_by_force || !request_state.compare_exchange_strong(expected, RequestState::being_made)) {
        return;
    }
    request.what = {};
    request.what << what;
    request.code = code;
    request.in_other_thread = in_other_thread;
    request.made_s = monotonic_s();
    request_state = RequestState::made;
    set_timer(ITIMER_REAL, kRetryPeriodS);
}

void drop_end_request() {
    request_state = RequestState::none;
}

EndRequest const* end_request() {
    return request_state.load(std::memory_order_acquire) == RequestState::made ? &request : nullptr;
}

void start_watch(double timeout_s) {
    request_state = RequestState::none;
    hurry_request = nullptr;
    busy = {.timeout_s = timeout_s};
    is_watching = true;
    catch_signal(SIGALRM, SA_RESTART, on_look);
    if (timeout_s > 0.0) {
        busy.period_s = std::max(kRetryPeriodS, std::min(kWatchPeriodS, timeout_s / 4.0));
        catch_signal(SIGPROF, SA_RESTART, on_watch);
        set_timer(ITIMER_PROF, busy.period_s);
    }
}

void watch_rescue() {
    rescue = {.writes_seen = save_progress().writes, .last_write_s = monotonic_s()};
    catch_signal(SIGALRM, SA_RESTART, on_look);
    set_timer(ITIMER_REAL, kRescueLookPeriodS);
}

void stop_watch() {
    is_watching = false;
    set_timer(ITIMER_PROF, 0.0);
    set_timer(ITIMER_REAL, 0.0);
}

bool is_signal_for_this_thread(int signal) {
    if (on_simulator_thread()) {
        return true;
    }
    pthread_kill(guard.thread, signal);
    return false;
}

void hurry_user_code(char const* request_name) {
    if (guard.left_by_force || !is_watching) {
        return;  // the timer watches over the data file, or the run is over: nobody would stop it
    }
    double const now_s = monotonic_s();
    double const entered_s = guard.entered_s.load(std::memory_order_relaxed);
    bool const has_limit = busy.timeout_s > 0.0;
    waiting = {.request_name = request_name,
               .calls_seen = guard.calls,
               .call_began_s = guard.inside && has_limit ? entered_s : now_s};
    if (guard.inside && now_s - entered_s > kPromptReturnS) {
        tell_what_is_waited_for();
    }
    set_timer(ITIMER_REAL, kLookPeriodS);
}

void hurry_user_code_from_thread(char const* request_name) {
    hurry_request = request_name;
    pthread_kill(guard.thread, SIGALRM);
}

void abandon_user_code() {
    if (guard.inside) {
        SignalText<512> what;
        what << "interrupted again before it returned" << (is_at_robots_start() ? kMoveTheLoop : "");
        request_end(what.c_str(), ExitCode::interrupted, /*in_other_thread=*/false);
    }
}

}  // namespace pogosim
