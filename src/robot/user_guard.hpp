// A fence around user code. Whatever happens inside (a crash, abort(), a step that never returns, an error in a call of
// the interface), control comes back here, so that the run can end with a message and a complete data file.
//
//   call_user_code(f) ──► sigsetjmp ──► f() ──► user's program
//          ▲                                        │ SIGSEGV, SIGFPE, SIGABRT, too long, leave_user_code()
//          └──────────────── siglongjmp ◄───────────┘
//
// A jump skips the destructors of every frame between, so the code between the fence and the user's functions keeps
// nothing that needs one.
#pragma once

#include <cstdio>
#include <exception>
#include <functional>
#include <optional>
#include <string>

namespace pogosim {

/// Exit codes of a program; exit(n) in user code ends with n, whatever it is.
enum class ExitCode : int { done = 0, usage = 2, user_program = 3, interrupted = 130 };

/// How user code ended when it did not return.
struct UserFailure {
    std::string what;  // "segmentation fault at address 0x10"
    ExitCode code = ExitCode::user_program;
    bool refused = false;  // a function of the interface said no: a wrong parameter, a column that is not there
};

/// Installs handlers for crashes and the watch over processor time. `timeout_s` is the processor time one call of user
/// code may take; 0: no limit. Call once, before user code runs.
void install_user_guard(double timeout_s);

/// Runs `body`, which calls user code. Returns nothing when it came back by itself. Not reentrant.
std::optional<UserFailure> call_user_code(std::function<void()> const& body);

/// Runs the simulator's own code, which may find its memory destroyed by user code. A crash in it, outside
/// call_user_code, comes back as a failure, once: the caller then saves what can be saved and ends the program.
std::optional<UserFailure> call_simulator_code(std::function<void()> const& body);

/// A new call of user code begins: the watch starts again from zero.
void restart_watch();

/// True while user code runs inside call_user_code.
bool inside_user_code();

/// Ends the running call_user_code with this failure. Does not return; outside user code it aborts.
[[noreturn]] void leave_user_code(char const* what, ExitCode code);

/// The same for a call that the interface refuses: exit code 2.
[[noreturn]] void refuse_user_code(char const* what);

/// The same from a signal handler, wherever user code is: what follows has some seconds before the program is ended.
/// Only inside user code.
[[noreturn]] void abandon_user_code(char const* what, ExitCode code);

/// Runs part of an interface function that may throw. An exception ends user code with its message and exit code 2,
/// instead of running through C frames.
template <class Body>
void without_exceptions(Body const& body) {
    char what[512];
    try {
        body();
        return;
    } catch (std::exception const& error) {
        std::snprintf(what, sizeof(what), "%s", error.what());
    }
    refuse_user_code(what);
}

}  // namespace pogosim
