// State of the crash handler of one run, shared by the handler (crash_handler.cpp), its watchdog (watchdog.cpp), the
// crash message (crash_message.cpp), and what watches processes, children and blocked calls. For this room only.
#pragma once

#include <sys/types.h>

#include <array>
#include <atomic>
#include <csetjmp>
#include <csignal>
#include <cstddef>
#include <cstdint>

#include "process/crash_handler.hpp"
#include "process/crash_message.hpp"
#include "process/running_code.hpp"
#include "process/sent_signals.hpp"
#include "process/signal_text.hpp"
#include "process/thread_timer.hpp"

namespace pogosim {

/// A request to end the run.
struct EndRequest {
    SignalText<512> what;
    ExitCode code = ExitCode::user_program;
    bool in_other_thread = false;
    void const* place = nullptr;  // see UserFailure
    double made_s = 0.0;
};
enum class RequestState { none, being_made, made };

/// Watches over the processor time of a call of user code.
struct ProcessorWatch {
    double timeout_s = 0.0;  // of one call of user code; 0: none
    double period_s = 0.0;
    unsigned long calls_seen = 0;
    double seen_at_s = 0.0;  // processor time of the thread when the present call was first seen
    bool retrying = false;
};

/// State from the request to stop onwards.
struct WallClockWatch {
    char const* request_name = "";  // "SIGTERM"
    unsigned long calls_seen = 0;
    double call_began_s = 0.0;  // of the call of user code that was seen last
    bool told = false;
};

/// Watches over the data file, after user code was left by force.
struct RescueWatch {
    std::uint64_t writes_seen = 0;
    double last_write_s = 0.0;
    double grace_s = 0.0;
};

/// State of the data file, for the crash message. Static memory, since the heap may be corrupted.
struct DataFileNote {
    std::atomic<DataFileState> state = DataFileState::none;
    std::array<char, 1024> path{};
};

struct CrashHandlerState {
    /// `in_program`: see CrashHandler.
    CrashHandlerState(RunningCode const& running_code, void const* in_program, double timeout_s);

    RunningCode const& running;  // for messages
    SignalledThread thread;      // that works for the run: the only one that may jump
    // Further threads that run user code at the same time, see WorkerCrashHandler.
    CrashHandlerState* helped = nullptr;                // the handler of their run; null: this is one
    std::atomic<CrashHandlerState*> helpers = nullptr;  // the first of them
    std::atomic<CrashHandlerState*> next_helper = nullptr;
    int depth = 0;  // of CrashHandlerScope
    void const* program_base = nullptr;
    sigjmp_buf return_point{};
    std::atomic<bool> inside = false;
    // Where a crash outside user code goes.
    sigjmp_buf rescue_point{};
    std::atomic<bool> rescuable = false;
    std::atomic<unsigned long> calls = 0;
    std::atomic<double> entered_s = 0.0;  // monotonic clock, at the last call_user_code()
    // What ended the call; plain memory, as a signal handler writes it.
    SignalText<512> what;
    ExitCode code = ExitCode::user_program;
    bool in_other_thread = false;
    bool refused = false;
    bool too_long = false;
    void const* place = nullptr;
    std::atomic<bool> crashed = false;
    std::atomic<bool> left_by_force = false;
    std::atomic<bool> expects_rescue = false;  // a helper was left by force, and all others are waited for

    // Requests to stop.
    std::atomic<int> interrupts = 0;
    std::atomic<double> interrupted_s = 0.0;  // when the last one came
    EndRequest request;
    std::atomic<RequestState> request_state = RequestState::none;
    std::atomic<char const*> hurry_request = nullptr;  // of another thread: hurry_user_code() with this name

    // The watch.
    std::atomic<bool> is_watching = false;
    ProcessorWatch busy;
    WallClockWatch waiting;
    RescueWatch rescue;
    ThreadTimers own_timers;
    ThreadTimers* timers = &own_timers;  // or those of its thread, see ThreadOfRuns

    // The watch over calls that block, see watch_over_blocked(): of the thread that runs user code.
    pid_t thread_id = 0;
    void const* thread_of_code = nullptr;  // see RunningCode::of_this_thread()
    bool is_told_of_blocked = false;

    // The crash message.
    DataFileNote data_file;
    CrashMessage crash_message;
    bool has_last_look = false;  // at destroyed memory, in give_up_rescue()
};

/// The run for which this thread works; null: none.
extern constinit thread_local CrashHandlerState* active_handler;

/// What the thread keeps from run to run; null: nothing.
extern constinit thread_local ThreadTimers* timers_of_thread;

/// The run that an executable is for: signals from outside, and crashes of unknown threads, are for it. Null
/// before and after it, and in other processes.
extern constinit std::atomic<CrashHandlerState*> process_run;

void set_reason(CrashHandlerState& handler, char const* text);

/// User code is left in the middle, or the simulator has crashed. What follows, until the data file is complete, may
/// crash or hang for ever: then the program ends with its crash message, which is composed here. For signal handlers.
void begin_rescue(CrashHandlerState& handler, char const* what, ExitCode code, bool in_other_thread);

/// The rescue has failed: memory is destroyed, or a lock held, beyond what the run needs to end well.
[[noreturn]] void give_up_rescue(CrashHandlerState& handler);

[[noreturn]] void jump_out(CrashHandlerState& handler, ExitCode code);

/// Where user code is, for the message; see place_in_program(). To be called when all else is prepared for the end.
void note_place(CrashHandlerState& handler, void const* signal_context = nullptr, int callees = 0);

/// False inside a library function such as malloc(), which may hold a lock that would never be released.
bool is_in_user_program(CrashHandlerState const& handler, void const* signal_context);

/// Requests the end of the run from anywhere: another thread, or a signal handler. User code is aborted as soon as it
/// holds no lock, as far as that can be determined; the simulator's own code runs to its end. Only the first request
/// counts. `place`: see UserFailure.
void request_end(CrashHandlerState& handler, char const* what, ExitCode code, bool in_other_thread,
                 void const* place = nullptr);

/// The request to stop; null while there is none.
EndRequest const* end_request(CrashHandlerState const& handler);

/// The request has been met: what remains is to save the data.
void drop_end_request(CrashHandlerState& handler);

/// The program was about to end this process by _exit(), which was prevented: leaves user code as after a crash. If
/// that is impossible, since exit handlers have run, says so, and ends the process. For signal handlers.
[[noreturn]] void leave_ending_process(int status, bool has_exit_begun, void const* signal_context);

/// In an executable, crashes are reported from the start to the end of the process.
void catch_crashes_of_process();

/// A signal asks the run to end: if user code does not return soon, prints what the run is waiting for, and aborts it
/// after `user_code_timeout` of wall-clock time. For signal handlers.
void hurry_user_code(CrashHandlerState& handler, char const* request_name);

/// A second signal aborts user code. Returns at once; does nothing outside user code. For signal handlers.
void abandon_user_code(CrashHandlerState& handler);

/// Handlers of all signals that concern runs, until they are given back. To be caught again when the host has handlers
/// of its own in the meantime.
void catch_signals_of_runs();
bool signals_of_runs_are_caught();
void give_back_signals_of_runs();

/// Those of the watch.
void catch_watch_signals();
void give_back_watch_signals();

/// Whether the host has functions of its own for the signals of the watch.
bool host_handles_watch_signals();

/// Catches them once more, since the host may have taken them.
void find_watch_signals_again();

/// Watches over the thread that calls this. `is_looked_at`: by the thread that watches over blocked calls, which lets
/// the watch over processor time begin when a call lasts, see arm_watch(): most are over before.
void start_watch(CrashHandlerState& handler, bool is_looked_at = false);

/// The watch over processor time begins, for a thread that may be another one, while it cannot stop.
void arm_watch(CrashHandlerState& handler);

/// From now on, the watchdog only checks that the data file makes progress. `grace_s`: time allowed until that starts.
void watch_rescue(CrashHandlerState& handler, double grace_s = 0.0);

void stop_watch(CrashHandlerState& handler);

// User code that blocks in wall-clock time, as in nanosleep(), read(), or for a lock: the whole run stands still, and
// the watch over processor time does not see it. A thread of the simulator looks at the threads that run user code,
// four times a second, without disturbing them: a signal would end some calls before their time.

/// The calling thread runs user code for this handler from now on, until end_watch_over_blocked(). Returns whether
/// there is a thread that looks.
bool watch_over_blocked(CrashHandlerState& handler);
void end_watch_over_blocked(CrashHandlerState& handler);

/// Whether that thread is there, and so calls let_go_of_signals().
bool watches_over_blocked();

/// In a child of fork(), in the thread that is left.
void forget_blocked_in_child();

}  // namespace pogosim
