// The signals that the simulator catches, in a program that may have handlers of its own.
#pragma once

#include <csignal>

namespace pogosim {

using SignalHandler = void (*)(int signal, siginfo_t* info, void* context);

/// From now on `handler` handles this signal. The signal is not blocked meanwhile, since a handler may leave by a jump.
/// `flags`: those of sigaction(). The handler before is kept, see pass_on().
void catch_signal(int signal, int flags, SignalHandler handler);

/// Whether that is so, as far as this process has been asked to.
bool is_caught(int signal);

/// Whether it is caught, and a function of the host handled it before.
bool has_handler_before(int signal);

/// Gives this signal back to the handler before, unless the program has taken it over since.
void give_back_signal(int signal);

/// Handles a signal that does not concern the simulator as if it had not been caught. For signal handlers.
void pass_on(int signal, siginfo_t* info, void* context);

/// Restores the default action of all signals caught above, except those that the program has taken over since. For
/// signal handlers.
void release_caught_signals();

}  // namespace pogosim
