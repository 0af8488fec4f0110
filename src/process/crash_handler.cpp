#include "process/crash_handler.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>

#include "base/background_thread.hpp"
#include "process/backtrace.hpp"
#include "process/caught_signals.hpp"
#include "process/crash_handler_state.hpp"
#include "process/crash_message.hpp"
#include "process/crash_name.hpp"
#include "process/fibers.hpp"
#include "process/other_threads.hpp"
#include "process/process.hpp"
#include "process/signals_of_runs.hpp"

namespace pogosim {

constinit thread_local CrashHandlerState* active_handler = nullptr;
constinit std::atomic<CrashHandlerState*> process_run = nullptr;

namespace {

constexpr double kNsPerS = 1e9;
constexpr double kSameRequestS = 0.1;  // timeout(1) and batch systems signal a process and its group: twice at once
constexpr auto kOwnMemoryAdvice =
    ", most likely because the user program wrote to memory it does not own; build the program with "
    "-fsanitize=address to find out where";

/// Stops the calling thread for ever, without ending the program.
[[noreturn]] void stop_this_thread() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, nullptr);
    for (;;) {
        pause();
    }
}

/// Ends the run as soon as the simulator's thread is back in control.
[[noreturn]] void end_run_from_background_thread(CrashHandlerState& run, char const* crash) {
    note_crash_of_background_thread();
    SignalText<512> what;
    what << "the simulator crashed while it was " << background_activity() << " (" << crash << ")" << kOwnMemoryAdvice;
    request_end(run, what.c_str(), ExitCode::user_program, /*in_other_thread=*/false);
    stop_this_thread();
}

void on_crash(int signal, siginfo_t* info, void* signal_context) {
    go_on_after_crash_of_backtrace();
    CrashHandlerState* const handler = active_handler;
    bool const is_others = is_other_thread_of_run();
    if (handler == nullptr && !is_others && !process_is_ours()) {
        pass_on(signal, info, signal_context);
        return;
    }
    CrashText const what = crash_name(signal, *info, signal_context);
    if (handler != nullptr && handler->helped != nullptr && !handler->inside) {
        end_run_from_background_thread(*handler->helped, what.c_str());
    }
    if (is_others) {
        if (background_activity() != nullptr) {
            end_run_from_background_thread(*process_run, what.c_str());
        }
        end_run_from_thread(what.c_str(), ExitCode::user_program, signal_context);
    }
    if (handler == nullptr) {
        prepare_crash_message(what.c_str(), !on_main_thread());
        end_with_crash_message(static_cast<int>(ExitCode::user_program));
    }
    if (handler->crashed.exchange(true)) {
        give_up_rescue(*handler);
    }
    begin_rescue(*handler, what.c_str(), ExitCode::user_program, /*in_other_thread=*/false);
    if (handler->inside) {
        note_place(*handler, signal_context);
        jump_out(*handler, ExitCode::user_program);
    }
    if (handler->rescuable.exchange(false)) {
        siglongjmp(handler->rescue_point, 1);
    }
    give_up_rescue(*handler);
}

/// Limits how long the thread of the run waits for its workers, some of which may now wait for ever for a lock.
void let_run_expect_rescue(CrashHandlerState const& helper) {
    CrashHandlerState& run = *helper.helped;
    set_reason(run, helper.what.c_str());
    run.code = helper.code;
    run.crash_message = helper.crash_message;
    run.expects_rescue = true;
    watch_rescue(run, run.busy.timeout_s);
}

UserFailure requested_failure(CrashHandlerState& handler, EndRequest const& request) {
    if (!handler.left_by_force) {
        begin_rescue(handler, request.what.c_str(), request.code, request.in_other_thread);
    }
    UserFailure failure{.what = request.what.c_str(),
                        .code = request.code,
                        .in_other_thread = request.in_other_thread,
                        .place = request.place};
    drop_end_request(handler);
    return failure;
}

/// The message of an exception that user code did not catch.
std::string text_of(std::exception const& error) {
    return dynamic_cast<std::bad_alloc const*>(&error) != nullptr ? std::string("C++ exception: ") + kOutOfMemory
                                                                  : std::string("C++ exception: ") + error.what();
}

UserFailure exception_failure(CrashHandlerState& handler, std::string const& what) {
    handler.inside = false;
    set_floating_point_mode(kStandardMode);
    if (is_forked_child()) {
        end_forked_child(static_cast<int>(ExitCode::user_program));
    }
    return {what, ExitCode::user_program};
}

}  // namespace

void catch_signals_of_runs() {
    for (int const signal : kCrashSignals) {
        catch_signal(signal, SA_ONSTACK, on_crash);
    }
    catch_watch_signals();
}

bool signals_of_runs_are_caught() {
    return is_caught(kCrashSignals.front());
}

void give_back_signals_of_runs() {
    give_back_watch_signals();
    for (int const signal : kCrashSignals) {
        give_back_signal(signal);
    }
}

void catch_crashes_of_process() {
    need_signals();
}

CrashHandlerState::CrashHandlerState(RunningCode const& running_code, void const* in_program, double timeout_s)
    : running(running_code), program_base(object_of(in_program)), busy{.timeout_s = timeout_s} {}

void CrashHandler::Destroy::operator()(CrashHandlerState* state) const {
    std::destroy_at(state);
}

CrashHandler::CrashHandler(RunningCode const& code, void const* in_program, double timeout_s)
    : memory_(sizeof(CrashHandlerState)), state_(new (memory_.data()) CrashHandlerState(code, in_program, timeout_s)) {
    static_assert(alignof(CrashHandlerState) <= 64, "what GuardedMemory gives");
}

CrashHandler::~CrashHandler() = default;

bool CrashHandler::was_left_by_force() const {
    return state_->left_by_force;
}

bool CrashHandler::was_interrupted() const {
    return state_->interrupts > 0;
}

CrashHandlerScope::CrashHandlerScope(CrashHandler& handler) : handler_(*handler.state_), before_(active_handler) {
    if (handler_.depth++ == 0) {
        thread_.emplace();
        watch_for_forks();
        handler_.thread = SignalledThread::current();
        handler_.inside = false;
        start_watch(handler_, watches_over_blocked());
        if (!watch_over_blocked(handler_)) {
            arm_watch(handler_);
        }
    }
    active_handler = &handler_;
}

CrashHandlerScope::~CrashHandlerScope() {
    if (--handler_.depth == 0) {
        end_watch_over_blocked(handler_);
        stop_watch(handler_);
        thread_.reset();
    }
    active_handler = before_;
}

WorkerCrashHandler::WorkerCrashHandler(CrashHandler& run)
    : run_(*run.state_), handler_(run_.running, run_.program_base, run_.busy.timeout_s) {
    CrashHandlerState& self = *handler_.state_;
    self.helped = &run_;
    self.next_helper = run_.helpers.load();
    run_.helpers = &self;
}

WorkerCrashHandler::~WorkerCrashHandler() {
    CrashHandlerState& self = *handler_.state_;
    std::atomic<CrashHandlerState*>* link = &run_.helpers;
    while (*link != &self) {
        link = &link->load()->next_helper;
    }
    *link = self.next_helper.load();
    end_watch_over_blocked(self);
    stop_watch(self);
    if (is_entered_) {
        need_signals_no_more();
    }
}

void WorkerCrashHandler::enter() {
    if (is_entered_) {
        return;
    }
    is_entered_ = true;
    use_large_signal_stack();
    CrashHandlerState& self = *handler_.state_;
    self.thread = SignalledThread::current();
    active_handler = &self;
    need_signals();
    start_watch(self);
    watch_over_blocked(self);
    sigset_t watch;
    sigemptyset(&watch);
    sigaddset(&watch, SIGALRM);
    sigaddset(&watch, SIGPROF);
    pthread_sigmask(SIG_UNBLOCK, &watch, nullptr);
}

void begin_rescue_of_run(UserFailure const& failure) {
    begin_rescue(*active_handler, failure.what.c_str(), failure.code, failure.in_other_thread);
}

ProcessRun::ProcessRun(CrashHandler& handler) {
    handler.state_->thread = SignalledThread::current();
    process_run = handler.state_.get();
    enter_stage(RunStage::running);  // from now on, signals are for the run
}

ProcessRun::~ProcessRun() {
    keep_data_file_note(process_run.load()->data_file);
    enter_stage(RunStage::finished);  // before, or a signal would find neither a run nor its end
    process_run = nullptr;
}

double monotonic_s() {
    timespec now = {};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) / kNsPerS;
}

void set_reason(CrashHandlerState& handler, char const* text) {
    handler.what = {};
    handler.what << text;
}

void begin_rescue(CrashHandlerState& handler, char const* what, ExitCode code, bool in_other_thread) {
    set_reason(handler, what);
    handler.code = code;
    handler.in_other_thread = in_other_thread;
    handler.left_by_force = true;
    if (handler.helped == nullptr) {
        watch_rescue(handler);
    }
    prepare_crash_message(what, in_other_thread);
    if (handler.helped != nullptr) {
        let_run_expect_rescue(handler);
    }
}

void give_up_rescue(CrashHandlerState& handler) {
    bool const looked = handler.has_last_look;  // looking at destroyed memory again may lead here again
    handler.has_last_look = true;
    if (handler.data_file.state == DataFileState::complete && !looked) {
        prepare_crash_message(handler.what.c_str(), handler.in_other_thread);
    }
    end_with_crash_message(static_cast<int>(handler.code));
}

void jump_out(CrashHandlerState& handler, ExitCode code) {
    handler.code = code;
    handler.inside = false;
    siglongjmp(handler.return_point, 1);
}

void note_place(CrashHandlerState& handler, void const* signal_context, int callees) {
    handler.place = place_in_program(handler.program_base, signal_context, callees);
}

bool is_in_user_program(CrashHandlerState const& handler, void const* signal_context) {
    void* const counter = program_counter(signal_context);
    Dl_info here;
    bool const known = counter != nullptr && handler.program_base != nullptr && dladdr(counter, &here) != 0;
    return !known || here.dli_fbase == handler.program_base;
}

std::optional<UserFailure> call_user_code(std::function<void()> const& body) {
    CrashHandlerState& handler = *active_handler;
    if (EndRequest const* const request = end_request(handler)) {
        return requested_failure(handler, *request);
    }
    if (sigsetjmp(handler.return_point, 0) != 0) {
        forget_running_fiber();
        set_floating_point_mode(kStandardMode);
        CrashHandlerState& run = *active_handler;
        EndRequest const* const request = end_request(run);
        return request != nullptr ? requested_failure(run, *request)
                                  : UserFailure{.what = run.what.c_str(),
                                                .code = run.code,
                                                .refused = run.refused,
                                                .too_long = run.too_long,
                                                .place = run.place};
    }
    handler.entered_s.store(monotonic_s(), std::memory_order_relaxed);
    handler.inside = true;
    handler.refused = false;
    handler.too_long = false;
    restart_watch();
    try {
        body();
    } catch (std::exception const& error) {
        return exception_failure(handler, text_of(error));
    } catch (...) {
        return exception_failure(handler, "C++ exception");
    }
    handler.inside = false;
    if (is_forked_child()) {
        end_forked_child(0);
    }
    if (EndRequest const* const request = end_request(handler)) {
        return requested_failure(handler, *request);
    }
    return std::nullopt;
}

std::optional<UserFailure> call_simulator_code(std::function<void()> const& body) {
    CrashHandlerState& handler = *active_handler;
    if (sigsetjmp(handler.rescue_point, 0) != 0) {
        forget_running_fiber();
        return UserFailure{
            std::string("the simulator crashed (") + active_handler->what.c_str() + ")" + kOwnMemoryAdvice,
            ExitCode::user_program};
    }
    handler.rescuable = true;
    body();
    handler.rescuable = false;
    return std::nullopt;
}

void restart_watch() {
    if (is_forked_child()) {
        end_forked_child(0);  // the next robot is the parent's
    }
    std::atomic<unsigned long>& calls = active_handler->calls;
    calls.store(calls.load(std::memory_order_relaxed) + 1, std::memory_order_release);
}

bool inside_user_code() {
    return active_handler != nullptr && active_handler->inside;
}

bool interrupted() {
    return active_handler != nullptr && active_handler->interrupts > 0;
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
    set_reason(*active_handler, what);
    note_place(*active_handler, nullptr, callees);
    jump_out(*active_handler, code);
}

void refuse_user_code(char const* what) {
    if (active_handler != nullptr) {
        active_handler->refused = true;
    }
    leave_user_code(what, ExitCode::usage);
}

bool is_other_thread_of_run() {
    return active_handler == nullptr && process_run != nullptr && !on_main_thread();
}

void end_run_from_thread(char const* what, ExitCode code, void const* signal_context, int callees) {
    void const* const place = place_in_program(process_run.load()->program_base, signal_context, callees);
    request_end(*process_run, what, code, /*in_other_thread=*/true, place);
    stop_this_thread();
}

void leave_ending_process(int status, bool has_exit_begun, void const* signal_context) {
    SignalText<512> what;
    what << "called _exit(" << (status < 0 ? "-" : "");
    what.whole(static_cast<std::uint64_t>(std::abs(std::int64_t{status})));
    what << ")";
    if (has_exit_begun || (active_handler == nullptr && !is_other_thread_of_run())) {
        prepare_plain_message("the program ended itself, before its check was complete");
        end_with_crash_message(static_cast<int>(ExitCode::user_program));
    }
    if (active_handler == nullptr) {
        end_run_from_thread(what.c_str(), ExitCode::user_program, signal_context);
    }
    CrashHandlerState& handler = *active_handler;
    begin_rescue(handler, what.c_str(), ExitCode::user_program, /*in_other_thread=*/false);
    if (!handler.inside) {
        give_up_rescue(handler);
    }
    note_place(handler, signal_context);
    jump_out(handler, ExitCode::user_program);
}

void check_end_of_thread() {
    constexpr auto kWhat = "called pthread_exit(), which ends the only thread that can run the simulator";
    bool const is_simulators = active_handler != nullptr || (process_is_ours() && on_main_thread());
    if (!is_simulators || is_forked_child()) {
        return;
    }
    if (inside_user_code()) {
        leave_user_code(kWhat, ExitCode::user_program);
    }
    std::fflush(nullptr);
    prepare_crash_message(kWhat, /*in_other_thread=*/false);
    end_with_crash_message(static_cast<int>(ExitCode::user_program));
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
    prepare_crash_message(what.c_str(), !on_main_thread());
    end_with_crash_message(static_cast<int>(ExitCode::user_program));
}

int note_interrupt(int signal, char const* name) {
    CrashHandlerState* const run = process_run;
    if (run == nullptr) {
        return 0;
    }
    if (!run->thread.is_current()) {
        pthread_kill(run->thread.id(), signal);
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
