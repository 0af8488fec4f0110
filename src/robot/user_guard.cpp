#include "robot/user_guard.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>

#include "base/background_thread.hpp"
#include "interface/pogobase_inside.hpp"
#include "robot/caught_signals.hpp"
#include "robot/crash_name.hpp"
#include "robot/forked_child.hpp"
#include "robot/guard_state.hpp"
#include "robot/last_words.hpp"
#include "robot/other_threads.hpp"

namespace pogosim {

Guard guard;

namespace {

constexpr double kNsPerS = 1e9;
constexpr auto kOwnMemoryAdvice =
    ", most likely because the user program wrote to memory it does not own; build the program with "
    "-fsanitize=address to find out where";

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
[[noreturn]] void end_run_from_background_thread(char const* crash) {
    note_crash_of_background_thread();
    SignalText<512> what;
    what << "the simulator crashed while it was drawing pictures (" << crash << ")" << kOwnMemoryAdvice;
    request_end(what.c_str(), ExitCode::user_program, /*in_other_thread=*/false);
    stop_this_thread();
}

void on_crash(int signal, siginfo_t* info, void* signal_context) {
    CrashText const what = crash_name(signal, *info, signal_context);
    if (on_background_thread()) {
        end_run_from_background_thread(what.c_str());
    }
    if (is_other_thread_of_run()) {
        end_run_from_thread(what.c_str(), ExitCode::user_program);
    }
    if (guard.crashed.exchange(true)) {
        give_up_rescue();
    }
    begin_rescue(what.c_str(), ExitCode::user_program, !on_simulator_thread());
    if (guard.inside) {
        jump_out(ExitCode::user_program);
    }
    if (on_simulator_thread() && guard.rescuable.exchange(false)) {
        siglongjmp(guard.rescue_point, 1);
    }
    give_up_rescue();
}

/// Before the constructors of the program, so that their crashes are also reported: this library is initialised first.
__attribute__((constructor)) void install_crash_handlers() {
    guard.thread = pthread_self();
    prepare_main_thread_for_crashes();
    for (int const signal : kCrashSignals) {
        catch_signal(signal, SA_ONSTACK, on_crash);
    }
    watch_for_forks();
}

UserFailure requested_failure(EndRequest const& request) {
    if (!guard.left_by_force) {
        begin_rescue(request.what.c_str(), request.code, request.in_other_thread);
    }
    UserFailure failure{request.what.c_str(), request.code, false, request.in_other_thread};
    drop_end_request();
    return failure;
}

/// What went wrong in an exception that user code did not catch.
std::string text_of(std::exception const& error) {
    return dynamic_cast<std::bad_alloc const*>(&error) != nullptr ? std::string("C++ exception: ") + kOutOfMemory
                                                                  : std::string("C++ exception: ") + error.what();
}

UserFailure exception_failure(std::string const& what) {
    guard.inside = false;
    if (is_forked_child()) {
        end_forked_child(static_cast<int>(ExitCode::user_program));
    }
    return {what, ExitCode::user_program};
}

}  // namespace

double monotonic_s() {
    timespec now = {};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) / kNsPerS;
}

bool on_simulator_thread() {
    return pthread_equal(pthread_self(), guard.thread) != 0;
}

void set_reason(char const* text) {
    guard.what = {};
    guard.what << text;
}

void begin_rescue(char const* what, ExitCode code, bool in_other_thread) {
    set_reason(what);
    guard.code = code;
    guard.in_other_thread = in_other_thread;
    guard.left_by_force = true;
    watch_rescue();
    prepare_last_words(what, in_other_thread);
}

void give_up_rescue() {
    static std::atomic<bool> composed = false;  // looking at destroyed memory again may lead here again
    if (data_file_is_complete() && !composed.exchange(true)) {
        prepare_last_words(guard.what.c_str(), guard.in_other_thread);
    }
    end_with_last_words(static_cast<int>(guard.code));
}

void jump_out(ExitCode code) {
    guard.code = code;
    guard.inside = false;
    siglongjmp(guard.return_point, 1);
}

bool is_in_user_program(void const* signal_context) {
    void* const counter = program_counter(signal_context);
    Dl_info here;
    Dl_info program;
    bool const known = counter != nullptr && dladdr(counter, &here) != 0 &&
                       dladdr(reinterpret_cast<void*>(&robot_main), &program) != 0;
    return !known || here.dli_fbase == program.dli_fbase;
}

void install_user_guard(double timeout_s) {
    guard.thread = pthread_self();
    guard.inside = false;
    guard.crashed = false;
    guard.left_by_force = false;
    note_data_file("", DataFileState::none);
    enter_stage(RunStage::running);
    start_watch(timeout_s);
}

void remove_user_guard() {
    stop_watch();
    enter_stage(RunStage::finished);
}

std::optional<UserFailure> call_user_code(std::function<void()> const& body) {
    if (EndRequest const* const request = end_request()) {
        return requested_failure(*request);
    }
    if (sigsetjmp(guard.return_point, 0) != 0) {
        EndRequest const* const request = end_request();
        return request != nullptr ? requested_failure(*request)
                                  : UserFailure{guard.what.c_str(), guard.code, guard.refused, false, guard.too_long};
    }
    guard.entered_s.store(monotonic_s(), std::memory_order_relaxed);
    guard.inside = true;
    guard.refused = false;
    guard.too_long = false;
    restart_watch();
    try {
        body();
    } catch (std::exception const& error) {
        return exception_failure(text_of(error));
    } catch (...) {
        return exception_failure("C++ exception");
    }
    guard.inside = false;
    if (is_forked_child()) {
        end_forked_child(0);
    }
    if (EndRequest const* const request = end_request()) {
        return requested_failure(*request);
    }
    return std::nullopt;
}

std::optional<UserFailure> call_simulator_code(std::function<void()> const& body) {
    if (sigsetjmp(guard.rescue_point, 0) != 0) {
        return UserFailure{std::string("the simulator crashed (") + guard.what.c_str() + ")" + kOwnMemoryAdvice,
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
    guard.calls.store(guard.calls.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

bool inside_user_code() {
    return guard.inside && on_simulator_thread();
}

bool was_left_by_force() {
    return guard.left_by_force;
}

void leave_user_code(char const* what, ExitCode code) {
    if (is_forked_child()) {
        std::fprintf(stderr, "pogosim: a child process of the user program: %s\n", what);
        end_forked_child(static_cast<int>(code));
    }
    if (!inside_user_code()) {
        std::fprintf(stderr, "pogosim: %s\n", what);
        std::abort();
    }
    set_reason(what);
    jump_out(code);
}

void refuse_user_code(char const* what) {
    guard.refused = true;
    leave_user_code(what, ExitCode::usage);
}

bool is_other_thread_of_run() {
    return run_stage() == RunStage::running && !on_simulator_thread();
}

void end_run_from_thread(char const* what, ExitCode code) {
    request_end(what, code, /*in_other_thread=*/true);
    stop_this_thread();
}

void check_end_of_thread() {
    constexpr auto kWhat = "called pthread_exit(), which ends the only thread that can run the simulator";
    if (!on_simulator_thread() || is_forked_child()) {
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
    prepare_last_words(what.c_str(), !on_simulator_thread());
    end_with_last_words(static_cast<int>(ExitCode::user_program));
}

}  // namespace pogosim
