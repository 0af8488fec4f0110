#include "robot/user_guard.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <mutex>

#include "base/background_thread.hpp"
#include "robot/backtrace.hpp"
#include "robot/blocked_watch.hpp"
#include "robot/caught_signals.hpp"
#include "robot/crash_name.hpp"
#include "robot/fibers.hpp"
#include "robot/forked_child.hpp"
#include "robot/guard_state.hpp"
#include "robot/last_words.hpp"
#include "robot/other_threads.hpp"
#include "robot/process.hpp"

namespace pogosim {

constinit thread_local RunGuard* active_guard = nullptr;
constinit std::atomic<RunGuard*> process_run = nullptr;

namespace {

constexpr double kNsPerS = 1e9;
constexpr double kSameRequestS = 0.1;  // timeout(1) and batch systems signal a process and its group: twice at once
constexpr auto kOwnMemoryAdvice =
    ", most likely because the user program wrote to memory it does not own; build the program with "
    "-fsanitize=address to find out where";

/// Signals that no run may lose: those of crashes, and of the watch.
class CaughtSignals {
public:
    void need();
    void need_no_more();

private:
    std::mutex mutex_;
    int needs_ = 0;
};
CaughtSignals caught_signals;

/// For good, without ending the program.
[[noreturn]] void stop_this_thread() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, nullptr);
    for (;;) {
        pause();
    }
}

/// The run ends as soon as the simulator's thread is back in control.
[[noreturn]] void end_run_from_background_thread(RunGuard& run, char const* crash) {
    note_crash_of_background_thread();
    SignalText<512> what;
    what << "the simulator crashed while it was " << background_activity() << " (" << crash << ")" << kOwnMemoryAdvice;
    request_end(run, what.c_str(), ExitCode::user_program, /*in_other_thread=*/false);
    stop_this_thread();
}

void on_crash(int signal, siginfo_t* info, void* signal_context) {
    go_on_after_crash_of_backtrace();
    RunGuard* const guard = active_guard;
    bool const is_others = is_other_thread_of_run();
    if (guard == nullptr && !is_others && !process_is_ours()) {
        pass_on(signal, info, signal_context);
        return;
    }
    CrashText const what = crash_name(signal, *info, signal_context);
    if (guard != nullptr && guard->helped != nullptr && !guard->inside) {
        end_run_from_background_thread(*guard->helped, what.c_str());
    }
    if (is_others) {
        if (background_activity() != nullptr) {
            end_run_from_background_thread(*process_run, what.c_str());
        }
        end_run_from_thread(what.c_str(), ExitCode::user_program, signal_context);
    }
    if (guard == nullptr) {
        prepare_last_words(what.c_str(), !on_main_thread());
        end_with_last_words(static_cast<int>(ExitCode::user_program));
    }
    if (guard->crashed.exchange(true)) {
        give_up_rescue(*guard);
    }
    begin_rescue(*guard, what.c_str(), ExitCode::user_program, /*in_other_thread=*/false);
    if (guard->inside) {
        note_place(*guard, signal_context);
        jump_out(*guard, ExitCode::user_program);
    }
    if (guard->rescuable.exchange(false)) {
        siglongjmp(guard->rescue_point, 1);
    }
    give_up_rescue(*guard);
}

void CaughtSignals::need() {
    std::lock_guard const lock(mutex_);
    if (needs_++ == 0) {
        for (int const signal : kCrashSignals) {
            catch_signal(signal, SA_ONSTACK, on_crash);
        }
        catch_watch_signals();
    }
}

void CaughtSignals::need_no_more() {
    std::lock_guard const lock(mutex_);
    if (--needs_ == 0) {
        give_back_watch_signals();
        for (int const signal : kCrashSignals) {
            give_back_signal(signal);
        }
    }
}

/// Limits how long the thread of the run waits for its workers, some of which may now wait for ever for a lock.
void let_run_expect_rescue(RunGuard const& helper) {
    RunGuard& run = *helper.helped;
    set_reason(run, helper.what.c_str());
    run.code = helper.code;
    run.last_words = helper.last_words;
    run.expects_rescue = true;
    watch_rescue(run, run.busy.timeout_s);
}

UserFailure requested_failure(RunGuard& guard, EndRequest const& request) {
    if (!guard.left_by_force) {
        begin_rescue(guard, request.what.c_str(), request.code, request.in_other_thread);
    }
    UserFailure failure{.what = request.what.c_str(),
                        .code = request.code,
                        .in_other_thread = request.in_other_thread,
                        .place = request.place};
    drop_end_request(guard);
    return failure;
}

/// What went wrong in an exception that user code did not catch.
std::string text_of(std::exception const& error) {
    return dynamic_cast<std::bad_alloc const*>(&error) != nullptr ? std::string("C++ exception: ") + kOutOfMemory
                                                                  : std::string("C++ exception: ") + error.what();
}

UserFailure exception_failure(RunGuard& guard, std::string const& what) {
    guard.inside = false;
    set_floating_point_mode(kStandardMode);
    if (is_forked_child()) {
        end_forked_child(static_cast<int>(ExitCode::user_program));
    }
    return {what, ExitCode::user_program};
}

}  // namespace

void catch_crashes_of_process() {
    caught_signals.need();
}

RunGuard::RunGuard(void const* code, double timeout_s)
    : program_base(object_of(code)),
      busy{.timeout_s = timeout_s},
      processor_timer(TimerClock::processor, SIGPROF, this),
      wall_timer(TimerClock::wall, SIGALRM, this) {}

void UserGuard::Destroy::operator()(RunGuard* state) const {
    std::destroy_at(state);
}

UserGuard::UserGuard(void const* code, double timeout_s)
    : memory_(sizeof(RunGuard)), state_(new (memory_.data()) RunGuard(code, timeout_s)) {
    static_assert(alignof(RunGuard) <= 64, "what FencedMemory gives");
}

UserGuard::~UserGuard() = default;

bool UserGuard::was_left_by_force() const {
    return state_->left_by_force;
}

GuardedThread::GuardedThread(UserGuard& guard) : guard_(*guard.state_), before_(active_guard) {
    if (guard_.depth++ == 0) {
        caught_signals.need();
        watch_for_forks();
        stack_.emplace();
        guard_.thread = pthread_self();
        guard_.inside = false;
        start_watch(guard_);
        watch_over_blocked(guard_);
    }
    active_guard = &guard_;
}

GuardedThread::~GuardedThread() {
    if (--guard_.depth == 0) {
        end_watch_over_blocked(guard_);
        stop_watch(guard_);
        caught_signals.need_no_more();
    }
    active_guard = before_;
}

HelperGuard::HelperGuard(UserGuard& run) : run_(*run.state_), guard_(run_.program_base, run_.busy.timeout_s) {
    RunGuard& self = *guard_.state_;
    self.helped = &run_;
    self.next_helper = run_.helpers.load();
    run_.helpers = &self;
}

HelperGuard::~HelperGuard() {
    RunGuard& self = *guard_.state_;
    std::atomic<RunGuard*>* link = &run_.helpers;
    while (*link != &self) {
        link = &link->load()->next_helper;
    }
    *link = self.next_helper.load();
    end_watch_over_blocked(self);
    stop_watch(self);
    if (is_entered_) {
        caught_signals.need_no_more();
    }
}

void HelperGuard::enter() {
    if (is_entered_) {
        return;
    }
    is_entered_ = true;
    static thread_local SignalStackScope const stack;  // as long as the thread
    RunGuard& self = *guard_.state_;
    self.thread = pthread_self();
    active_guard = &self;
    caught_signals.need();
    start_watch(self);
    watch_over_blocked(self);
    sigset_t watch;
    sigemptyset(&watch);
    sigaddset(&watch, SIGALRM);
    sigaddset(&watch, SIGPROF);
    pthread_sigmask(SIG_UNBLOCK, &watch, nullptr);
}

void begin_rescue_of_run(UserFailure const& failure) {
    begin_rescue(*active_guard, failure.what.c_str(), failure.code, failure.in_other_thread);
}

ProcessRun::ProcessRun(UserGuard& guard) {
    enter_stage(RunStage::running);
    guard.state_->thread = pthread_self();
    process_run = guard.state_.get();
}

ProcessRun::~ProcessRun() {
    keep_data_file_note(process_run.load()->data_file);
    process_run = nullptr;
    enter_stage(RunStage::finished);
}

double monotonic_s() {
    timespec now = {};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) / kNsPerS;
}

void set_reason(RunGuard& guard, char const* text) {
    guard.what = {};
    guard.what << text;
}

void begin_rescue(RunGuard& guard, char const* what, ExitCode code, bool in_other_thread) {
    set_reason(guard, what);
    guard.code = code;
    guard.in_other_thread = in_other_thread;
    guard.left_by_force = true;
    if (guard.helped == nullptr) {
        watch_rescue(guard);
    }
    prepare_last_words(what, in_other_thread);
    if (guard.helped != nullptr) {
        let_run_expect_rescue(guard);
    }
}

void give_up_rescue(RunGuard& guard) {
    bool const looked = guard.has_last_look;  // looking at destroyed memory again may lead here again
    guard.has_last_look = true;
    if (guard.data_file.state == DataFileState::complete && !looked) {
        prepare_last_words(guard.what.c_str(), guard.in_other_thread);
    }
    end_with_last_words(static_cast<int>(guard.code));
}

void jump_out(RunGuard& guard, ExitCode code) {
    guard.code = code;
    guard.inside = false;
    siglongjmp(guard.return_point, 1);
}

void note_place(RunGuard& guard, void const* signal_context, int callees) {
    guard.place = place_in_program(guard.program_base, signal_context, callees);
}

bool is_in_user_program(RunGuard const& guard, void const* signal_context) {
    void* const counter = program_counter(signal_context);
    Dl_info here;
    bool const known = counter != nullptr && guard.program_base != nullptr && dladdr(counter, &here) != 0;
    return !known || here.dli_fbase == guard.program_base;
}

std::optional<UserFailure> call_user_code(std::function<void()> const& body) {
    RunGuard& guard = *active_guard;
    if (EndRequest const* const request = end_request(guard)) {
        return requested_failure(guard, *request);
    }
    if (sigsetjmp(guard.return_point, 0) != 0) {
        forget_running_fiber();
        set_floating_point_mode(kStandardMode);
        RunGuard& run = *active_guard;
        EndRequest const* const request = end_request(run);
        return request != nullptr ? requested_failure(run, *request)
                                  : UserFailure{.what = run.what.c_str(),
                                                .code = run.code,
                                                .refused = run.refused,
                                                .too_long = run.too_long,
                                                .place = run.place};
    }
    guard.entered_s.store(monotonic_s(), std::memory_order_relaxed);
    guard.inside = true;
    guard.refused = false;
    guard.too_long = false;
    restart_watch();
    try {
        body();
    } catch (std::exception const& error) {
        return exception_failure(guard, text_of(error));
    } catch (...) {
        return exception_failure(guard, "C++ exception");
    }
    guard.inside = false;
    if (is_forked_child()) {
        end_forked_child(0);
    }
    if (EndRequest const* const request = end_request(guard)) {
        return requested_failure(guard, *request);
    }
    return std::nullopt;
}

std::optional<UserFailure> call_simulator_code(std::function<void()> const& body) {
    RunGuard& guard = *active_guard;
    if (sigsetjmp(guard.rescue_point, 0) != 0) {
        forget_running_fiber();
        return UserFailure{std::string("the simulator crashed (") + active_guard->what.c_str() + ")" + kOwnMemoryAdvice,
                           ExitCode::user_program};
    }
    guard.rescuable = true;
    body();
    guard.rescuable = false;
    return std::nullopt;
}

void restart_watch() {
    if (is_forked_child()) {
        end_forked_child(0);  // the next robot is the parent's
    }
    std::atomic<unsigned long>& calls = active_guard->calls;
    calls.store(calls.load(std::memory_order_relaxed) + 1, std::memory_order_release);
}

bool inside_user_code() {
    return active_guard != nullptr && active_guard->inside;
}

bool interrupted() {
    return active_guard != nullptr && active_guard->interrupts > 0;
}

void leave_user_code(char const* what, ExitCode code, int callees) {
    if (is_forked_child()) {
        std::fprintf(stderr, "pogosim: a child process of the user program: %s\n", what);
        end_forked_child(static_cast<int>(code));
    }
    if (!inside_user_code()) {
        std::fprintf(stderr, "pogosim: %s\n", what);
        std::abort();
    }
    set_reason(*active_guard, what);
    note_place(*active_guard, nullptr, callees);
    jump_out(*active_guard, code);
}

void refuse_user_code(char const* what) {
    if (active_guard != nullptr) {
        active_guard->refused = true;
    }
    leave_user_code(what, ExitCode::usage);
}

bool is_other_thread_of_run() {
    return active_guard == nullptr && process_run != nullptr && !on_main_thread();
}

void end_run_from_thread(char const* what, ExitCode code, void const* signal_context, int callees) {
    void const* const place = place_in_program(process_run.load()->program_base, signal_context, callees);
    request_end(*process_run, what, code, /*in_other_thread=*/true, place);
    stop_this_thread();
}

void check_end_of_thread() {
    constexpr auto kWhat = "called pthread_exit(), which ends the only thread that can run the simulator";
    bool const is_simulators = active_guard != nullptr || (process_is_ours() && on_main_thread());
    if (!is_simulators || is_forked_child()) {
        return;
    }
    if (inside_user_code()) {
        leave_user_code(kWhat, ExitCode::user_program);
    }
    std::fflush(nullptr);
    prepare_last_words(kWhat, /*in_other_thread=*/false);
    end_with_last_words(static_cast<int>(ExitCode::user_program));
}

void called_without_robot(char const* function) {
    CrashText what;
    what << function << "() was called ";
    if (is_other_thread_of_run()) {
        what << "there, but only main(), the steps and the callbacks run on a robot";
        end_run_from_thread(what.c_str(), ExitCode::user_program);
    }
    what << "while no robot was running; call it in main(), user_init(), user_step() or a callback";
    std::fflush(nullptr);
    prepare_last_words(what.c_str(), !on_main_thread());
    end_with_last_words(static_cast<int>(ExitCode::user_program));
}

int note_interrupt(int signal, char const* name) {
    RunGuard* const run = process_run;
    if (run == nullptr) {
        return 0;
    }
    if (pthread_equal(run->thread, pthread_self()) == 0) {
        pthread_kill(run->thread, signal);
        return 0;
    }
    double const now_s = monotonic_s();
    bool const same = run->interrupts > 0 && now_s - run->interrupted_s < kSameRequestS;
    run->interrupted_s = now_s;
    if (same) {
        return 0;
    }
    int const count = ++run->interrupts;
    if (count == 1) {
        hurry_user_code(*run, name);
    } else {
        abandon_user_code(*run);
    }
    return count;
}

}  // namespace pogosim
