// The process in which runs go on: an executable, which is made for one program, or a host such as Python, which has
// other work to do.
#pragma once

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

}  // namespace pogosim
