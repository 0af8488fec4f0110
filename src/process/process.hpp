// The process in which runs go on: an executable, which is made for one program, or a host such as Python, which has
// other work to do.
#pragma once

#include <sys/types.h>

namespace pogosim {

/// This process is an executable made of a program: from now on its crashes and children are reported, also before
/// main(). Call it in the main thread.
void take_process();

/// False in a host.
bool process_is_ours();

bool on_main_thread();

/// As _exit(), also where that is trapped because the program is not to end the process (without_effects.hpp).
[[noreturn]] void end_process(int code);

// What the system is given then: it takes the lowest bits.
inline constexpr unsigned kExitCodeBits = 0xff;
inline constexpr unsigned kOwnEnd = 0x706f6700;

// A program may call fork(). The child is a copy of the whole run, but the data file, the console and the messages are
// the parent's: the child runs its own code and ends quietly, at the latest when that returns to the simulator.

/// Detects children from now on.
void watch_for_forks();

/// True in a child.
bool is_forked_child();

/// As fork(), with a child that is an executable of its own, in which everything is as it was here.
pid_t fork_executable();

/// Ends the child: flushes its own output, without calling any handler or destructor of the run.
[[noreturn]] void end_forked_child(int status);

}  // namespace pogosim
