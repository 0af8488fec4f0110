// The signals that the simulator catches, in a program that may catch some itself, or that has others of its own.
#pragma once

#include <csignal>

namespace pogosim {

using SignalHandler = void (*)(int signal, siginfo_t* info, void* context);

/// From now on `handler` has this signal, which interrupts it, too: a handler may leave by a jump. `flags` as of
/// sigaction(). What had the signal before is kept, see pass_on().
void catch_signal(int signal, int flags, SignalHandler handler);

/// This signal goes again where it went before, unless the program has taken it over since.
void give_back_signal(int signal);

/// For a signal that is none of ours: does what would have happened if it had not been caught. For signal handlers.
void pass_on(int signal, siginfo_t* info, void* context);

/// Signals caught above have their usual effect again, except those that the program has taken over since. For signal
/// handlers.
void release_caught_signals();

}  // namespace pogosim
