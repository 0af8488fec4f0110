// Descriptions of crashes for messages.
#pragma once

#include <array>
#include <csignal>

#include "process/signal_text.hpp"

namespace pogosim {

using CrashText = SignalText<512>;

inline constexpr std::array kCrashSignals{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGSYS, SIGABRT};

/// Notes where the stack of this thread ends, for crash_name(). Not for signal handlers.
void note_stack();

/// "segmentation fault at address 0x10"; for signal handlers. `signal_context` is what the handler was given.
CrashText crash_name(int signal, siginfo_t const& info, void const* signal_context);

/// Return address of the function that has just been called, if its first instruction failed; otherwise any address.
void const* return_address(void const* signal_context);

/// The instruction pointer at the time of the signal; null on unknown architectures.
void* program_counter(void const* signal_context);

}  // namespace pogosim
