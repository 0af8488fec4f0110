// The signals that the simulator catches, in a program that may catch some itself.
#pragma once

#include <csignal>

namespace pogosim {

using SignalHandler = void (*)(int signal, siginfo_t* info, void* context);

/// From now on `handler` has this signal, which interrupts it, too: a handler may leave by a jump. `flags` as of
/// sigaction(). For signal handlers.
void catch_signal(int signal, int flags, SignalHandler handler);

/// Signals caught above have their usual effect again, except those that the program has taken over since. For signal
/// handlers.
void release_caught_signals();

}  // namespace pogosim
