// The simulator's own threads, which never run user code.
#pragma once

#include <functional>
#include <thread>

namespace pogosim {

/// Runs `body`, which must not throw, in a thread that takes no signals from outside: Ctrl-C and timers are for the
/// thread that runs the robots. Crashes are still reported. `activity`, a literal: what the thread does, for messages,
/// "drawing pictures". Throws std::system_error if the system has no thread left.
std::thread start_background_thread(char const* activity, std::function<void()> body);

/// The activity of a thread started this way; null in all others.
char const* background_activity();

/// Notes that a thread started this way has crashed and has been stopped where it was: no thread may wait for it any
/// more. For signal handlers.
void note_crash_of_background_thread();
bool has_background_thread_crashed();

}  // namespace pogosim
