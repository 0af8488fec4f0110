// The crash handler. Whatever happens in user code (a crash, abort(), a step that never returns, an error in an
// interface function), control returns here, so that the run can end with a message and a complete data file.
//
//   call_user_code(f) ──► sigsetjmp ──► f() ──► user's program
//          ▲                                        │ SIGSEGV, SIGFPE, SIGABRT, too long, leave_user_code()
//          └──────────────── siglongjmp ◄───────────┘
//
// A jump skips the destructors of every frame in between, so the code between call_user_code() and the user's
// functions owns nothing that needs one.
//
// Crashes elsewhere end the program with a message (crash_message.hpp): in constructors before main(), in atexit()
// handlers and destructors after the run. One in a thread that the program started ends the run as one in user code.
#pragma once

#include <cstdio>
#include <exception>
#include <functional>
#include <memory>
#include <new>
#include <optional>
#include <string>

#include "base/floating_point.hpp"
#include "base/memory.hpp"
#include "process/program_memory.hpp"
#include "process/running_code.hpp"
#include "process/signals_of_runs.hpp"

namespace pogosim {

/// Exit codes of a program; exit(n) in user code ends with n, whatever it is.
enum class ExitCode : int { done = 0, usage = 2, user_program = 3, interrupted = 130 };

/// How user code ended when it did not return.
struct UserFailure {
    std::string what;  // "segmentation fault at address 0x10"
    ExitCode code = ExitCode::user_program;
    bool refused = false;          // rejected by an interface function: an invalid parameter, an unknown column
    bool in_other_thread = false;  // in one that the program started
    bool too_long = false;         // it had not returned after user_code_timeout
    void const* place = nullptr;   // in the program's code, that was executed last; null: unknown
    std::string where{};           // "user_step of robot #3"; empty: what this process ran last
};

struct CrashHandlerState;

/// The crash handler of one run.
class CrashHandler {
public:
    /// `code`: for messages. `in_program`: any place in the code of the program. `timeout_s`: processor time that one
    /// call of user code may take; 0: no limit.
    CrashHandler(RunningCode const& code, void const* in_program, double timeout_s);
    ~CrashHandler();
    CrashHandler(CrashHandler const&) = delete;
    CrashHandler& operator=(CrashHandler const&) = delete;

    /// True if user code was aborted: no destructor or atexit() handler may rely on its memory and locks.
    bool was_left_by_force() const;

    /// True if the run was asked to end by a signal; also after the run.
    bool was_interrupted() const;

    /// Asks the run to end, from another thread of the simulator; `request_name` names the cause. If user code does not
    /// return soon, prints what the run is waiting for, and aborts it after `user_code_timeout` of wall-clock time.
    void hurry(char const* request_name);

private:
    friend class CrashHandlerScope;
    friend class WorkerCrashHandler;
    friend class ProcessRun;
    struct Destroy {
        void operator()(CrashHandlerState* state) const;
    };

    GuardedMemory memory_;  // of the state: a program that writes over the heap does not reach it
    std::unique_ptr<CrashHandlerState, Destroy> state_;
};

/// The crash handler of a worker that runs user code beside the thread of the run. Crashes and endless loops in that
/// code end the call in this thread; requests to end the run reach this thread, too.
class WorkerCrashHandler {
public:
    explicit WorkerCrashHandler(CrashHandler& run);
    /// To be called when its thread has ended, or does nothing any more.
    ~WorkerCrashHandler();
    WorkerCrashHandler(WorkerCrashHandler const&) = delete;
    WorkerCrashHandler& operator=(WorkerCrashHandler const&) = delete;

    /// The calling thread, always the same background thread, may use call_user_code() from now on.
    void enter();

    /// True if user code was aborted here, see begin_rescue_of_run().
    bool was_left_by_force() const { return handler_.was_left_by_force(); }

private:
    CrashHandlerState& run_;
    CrashHandler handler_;
    bool is_entered_ = false;
};

/// While this exists, the calling thread works for a run: its crashes, and the functions below, belong to that run.
/// Installs signal handlers, see signals_of_runs.hpp. May be nested in a thread; a run has one thread at a time.
class CrashHandlerScope {
public:
    explicit CrashHandlerScope(CrashHandler& handler);
    ~CrashHandlerScope();
    CrashHandlerScope(CrashHandlerScope const&) = delete;
    CrashHandlerScope& operator=(CrashHandlerScope const&) = delete;

private:
    CrashHandlerState& handler_;
    CrashHandlerState* before_;
    std::optional<ThreadOfRuns> thread_{};
    StandardFloatingPoint mode_{};
};

/// While this exists, signals that ask this process to end belong to that run, and so do crashes in threads that the
/// program has started: an executable has one run at a time. Created in the thread that works for the run.
class ProcessRun {
public:
    explicit ProcessRun(CrashHandler& handler);
    ~ProcessRun();
    ProcessRun(ProcessRun const&) = delete;
    ProcessRun& operator=(ProcessRun const&) = delete;
};

// The following functions concern the run for which this thread works; call_user_code() and call_simulator_code() need
// one.

/// Runs `body`, which calls user code. Returns nothing if it returned normally. Not reentrant.
std::optional<UserFailure> call_user_code(std::function<void()> const& body);

/// Runs the simulator's own code, whose memory user code may have corrupted. A crash in it, outside call_user_code, is
/// returned as a failure, once: the caller then saves as much as possible and ends the program.
std::optional<UserFailure> call_simulator_code(std::function<void()> const& body);

/// User code has failed in a worker's thread and was aborted there: this thread, that of the run, saves the data.
void begin_rescue_of_run(UserFailure const& failure);

/// A new call of user code begins: the watchdog starts again from zero.
void restart_watch();

/// True while user code runs inside call_user_code, for the thread that runs it.
bool inside_user_code();

/// True if this run was asked to end by a signal.
bool interrupted();

/// Ends the running call_user_code with this failure. Does not return; outside user code it aborts.
/// `callees`: functions of ours in the program which it has called, and that the message does not name.
[[noreturn]] void leave_user_code(char const* what, ExitCode code, int callees = 0);

/// The same for a call that the interface refuses: exit code 2.
[[noreturn]] void refuse_user_code(char const* what);

/// True in a thread that the program started, while the run goes on.
bool is_other_thread_of_run();

/// Ends the run from another thread, which stops here: the run ends with this failure and a complete data file.
/// `signal_context`: of its crash; null: it has called a function of the interface.
/// `callees`: see leave_user_code().
[[noreturn]] void end_run_from_thread(char const* what, ExitCode code, void const* signal_context = nullptr,
                                      int callees = 0);

/// An interface function was called while no robot was running: before main(), after the run or in a thread that the
/// program started. Ends the program with a message and exit code 3.
[[noreturn]] void called_without_robot(char const* function);

/// To be called by a thread that is about to end. Returns in a thread that the program started. The simulator's own
/// must not end: user code is left with a failure; elsewhere, the program ends with a message and exit code 3.
void check_end_of_thread();

/// A signal asks the process's run to end: the first one hurries user code, see CrashHandler::hurry(); a second one
/// aborts it. Returns how many have come; 0 if there is no such run, or the signal was passed on to its thread. For
/// handlers of signals that may come on any thread.
int note_interrupt(int signal, char const* name);

/// Seconds of the monotonic clock. Also for signal handlers.
double monotonic_s();

/// Runs part of an interface function that may throw. An exception ends user code with its message and exit code 2,
/// instead of running through C frames.
template <class Body>
void without_exceptions(Body const& body) {
    char what[512];
    try {
        body();
        return;
    } catch (std::bad_alloc const&) {
        std::snprintf(what, sizeof(what), "%s", kOutOfMemory);
    } catch (std::exception const& error) {
        std::snprintf(what, sizeof(what), "%s", error.what());
    }
    refuse_user_code(what);
}

}  // namespace pogosim
