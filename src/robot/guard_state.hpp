// State shared by the fence around user code (user_guard.cpp) and its watchdog (user_watch.cpp). Not included anywhere
// else.
#pragma once

#include <pthread.h>

#include <atomic>
#include <csetjmp>
#include <csignal>

#include "robot/signal_text.hpp"
#include "robot/user_guard.hpp"

namespace pogosim {

struct Guard {
    pthread_t thread{};  // the simulator's: the only one that may jump
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
    std::atomic<bool> crashed = false;
    std::atomic<bool> left_by_force = false;
};

extern Guard guard;

bool on_simulator_thread();

void set_reason(char const* text);

/// User code is left in the middle, or the simulator has crashed. What follows, until the data file is complete, may
/// crash or hang for ever: then the program ends with its last words, which are composed here. For signal handlers.
void begin_rescue(char const* what, ExitCode code, bool in_other_thread);

/// The rescue has failed: memory is destroyed, or a lock held, beyond what the run needs to end well.
[[noreturn]] void give_up_rescue();

[[noreturn]] void jump_out(ExitCode code);

/// False inside a library function such as malloc(), which may hold a lock that would never be released.
bool is_in_user_program(void const* signal_context);

/// Requests the end of the run from anywhere: another thread, or a signal handler. User code is aborted as soon as it
/// holds no lock, as far as that can be determined; the simulator's own code runs to its end. Only the first request
/// counts.
void request_end(char const* what, ExitCode code, bool in_other_thread);

struct EndRequest {
    SignalText<512> what;
    ExitCode code = ExitCode::user_program;
    bool in_other_thread = false;
    double made_s = 0.0;
};

/// Null while there is none.
EndRequest const* end_request();

/// It has been met: what remains is to save the data.
void drop_end_request();

void start_watch(double timeout_s);

/// From now on the only thing that is watched is that the data file gets on.
void watch_rescue();

void stop_watch();

}  // namespace pogosim
