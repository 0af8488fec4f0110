// The watch over user code that does not return: by processor time (SIGPROF), which a program on a busy machine does
// not use up by waiting; and, once the run was asked to end, by wall-clock time (SIGALRM), which runs in sleep(), too.
#include <sys/time.h>

#include <algorithm>
#include <string_view>

#include "robot/context.hpp"
#include "robot/guard_state.hpp"
#include "robot/last_words.hpp"
#include "robot/user_guard.hpp"

namespace pogosim {

namespace {

constexpr double kWatchPeriodS = 0.25;   // of processor time
constexpr double kRetryPeriodS = 0.001;  // in which user code is looked for outside of libraries
constexpr int kMaxRetries = 250;
constexpr double kLookPeriodS = 0.05;   // of wall-clock time
constexpr double kPromptReturnS = 0.1;  // nobody need be told to wait for less
constexpr double kPromptEndS = 1.0;     // of a step of the simulator's own, and of the data file
constexpr double kPatienceS = 10.0;     // for user code without a limit, and for the simulator's own

struct ProcessorWatch {
    double timeout_s = 0.0;
    double period_s = kWatchPeriodS;
    double seen_busy_s = 0.0;
    int retries = 0;
    unsigned long calls_seen = 0;
};

/// Since the run was asked to end.
struct WallClockWatch {
    char const* signal_name = "";
    unsigned long calls_seen = 0;
    double call_began_s = 0.0;  // of the call of user code that was seen last
    bool told = false;
};

ProcessorWatch busy;
WallClockWatch waiting;

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

void on_watch(int signal, siginfo_t* /*info*/, void* signal_context) {
    if (!is_signal_for_this_thread(signal)) {
        return;
    }
    if (!guard.inside || guard.calls != busy.calls_seen) {
        busy.calls_seen = guard.calls;
        busy.seen_busy_s = 0.0;
        if (busy.retries > 0) {
            busy.retries = 0;
            set_timer(ITIMER_PROF, busy.period_s);
        }
        return;
    }
    busy.seen_busy_s += busy.retries > 0 ? kRetryPeriodS : busy.period_s;
    if (busy.seen_busy_s < busy.timeout_s) {
        return;
    }
    if (!is_in_user_program(signal_context) && busy.retries < kMaxRetries) {
        ++busy.retries;
        set_timer(ITIMER_PROF, kRetryPeriodS);
        return;
    }
    SignalText<512> what;
    what << "did not return within ";
    what.number(busy.timeout_s, 6, /*kept=*/false) << " s of processor time (user_code_timeout)";
    what << (is_at_robots_start() ? kMoveTheLoop
                                  : "; messages and sensors do not change while user code runs, so a step must not "
                                    "wait for them in a loop");
    set_reason(what.c_str());
    guard.too_long = true;
    expect_the_worst();
    jump_out(ExitCode::user_program);
}

/// Tells the user who waits, once.
void tell_what_is_waited_for() {
    if (waiting.told) {
        return;
    }
    waiting.told = true;
    SignalText<1024> text;
    text << "pogosim: " << waiting.signal_name << ": the run ends when ";
    if (guard.inside) {
        text << running_place().c_str() << ", returns. A second signal leaves it at once; by itself it is left ";
        if (busy.timeout_s > 0.0) {
            text.number(busy.timeout_s, 6, /*kept=*/false) << " s after its start (user_code_timeout).\n";
        } else {
            text.number(kPatienceS, 0) << " s from now (there is no user_code_timeout).\n";
        }
    } else {
        text << "the simulator has ended this step and completed the data file.\n";
    }
    text.write_to_stderr();
}

/// Leaves user code as asked for, where that does no harm.
void look_after_request(void const* signal_context, double now_s) {
    double const asked_since_s = now_s - request.made_s;
    if (!guard.inside) {
        // call_user_code() sees the request, unless the simulator waits for a lock that is gone.
        if (asked_since_s > kPatienceS) {
            guard.code = request.code;
            prepare_last_words(request.what.c_str(), request.in_other_thread);
            end_with_last_words(static_cast<int>(request.code));
        }
        return;
    }
    if (is_in_user_program(signal_context) || asked_since_s > kMaxRetries * kRetryPeriodS) {
        set_reason(request.what.c_str());
        guard.code = request.code;
        guard.left_by_force = true;
        expect_the_worst();
        jump_out(request.code);
    }
}

void on_look(int signal, siginfo_t* /*info*/, void* signal_context) {
    if (!is_signal_for_this_thread(signal)) {
        return;
    }
    double const now_s = monotonic_s();
    if (end_request() != nullptr) {
        look_after_request(signal_context, now_s);
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
            what << " s after its start (user_code_timeout), and " << waiting.signal_name << " asked the run to end";
        } else {
            what << " s after " << waiting.signal_name << " asked the run to end";
        }
        what << (is_at_robots_start() ? kMoveTheLoop : "");
        request_end(what.c_str(), ExitCode::interrupted, /*in_other_thread=*/false);
    }
}

}  // namespace

void request_end(char const* what, ExitCode code, bool in_other_thread) {
    RequestState expected = RequestState::none;
    if (!request_state.compare_exchange_strong(expected, RequestState::being_made)) {
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

EndRequest const* end_request() {
    return request_state.load(std::memory_order_acquire) == RequestState::made ? &request : nullptr;
}

void start_watch(double timeout_s) {
    request_state = RequestState::none;
    busy = {.timeout_s = timeout_s};
    install_handler(SIGALRM, SA_RESTART, on_look);
    if (timeout_s > 0.0) {
        busy.period_s = std::max(kRetryPeriodS, std::min(kWatchPeriodS, timeout_s / 4.0));
        install_handler(SIGPROF, SA_RESTART, on_watch);
        set_timer(ITIMER_PROF, busy.period_s);
    }
}

void stop_watch() {
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

void hurry_user_code(char const* signal_name) {
    double const now_s = monotonic_s();
    double const entered_s = guard.entered_s.load(std::memory_order_relaxed);
    bool const has_limit = busy.timeout_s > 0.0;
    waiting = {.signal_name = signal_name,
               .calls_seen = guard.calls,
               .call_began_s = guard.inside && has_limit ? entered_s : now_s};
    if (guard.inside && now_s - entered_s > kPromptReturnS) {
        tell_what_is_waited_for();
    }
    set_timer(ITIMER_REAL, kLookPeriodS);
}

void abandon_user_code() {
    if (guard.inside) {
        SignalText<512> what;
        what << "interrupted again before it returned" << (is_at_robots_start() ? kMoveTheLoop : "");
        request_end(what.c_str(), ExitCode::interrupted, /*in_other_thread=*/false);
    }
}

}  // namespace pogosim
