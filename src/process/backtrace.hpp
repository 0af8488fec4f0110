// Where in a program's code a crash or a refused call came from: the place in memory, and the line of its source.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

namespace pogosim {

struct ProgramImage;

/// The place in the code of a program that was executed last. Skips functions of libraries and of the simulator that it
/// has called, and `callees` functions of its own. `program_base`: where the program is loaded. Null:
/// unknown, as when the stack is destroyed. Also for signal handlers.
void const* place_in_program(void const* program_base, void const* signal_context = nullptr, int callees = 0);

/// Where the program or library with this code is loaded; null: unknown.
void const* object_of(void const* code);

/// Whether this function is among the callers of the code that asks: it has a frame on the stack of this thread.
bool is_being_called(void const* function);

/// For crash handlers: if place_in_program() itself has crashed, as on a destroyed stack, jumps back into it.
void go_on_after_crash_of_backtrace();

// The stack of another thread of this process, one that waits in the kernel.

/// As /proc/self/task/THREAD/syscall shows it.
struct ThreadPlace {
    std::uintptr_t stack_pointer = 0;
    std::uintptr_t program_counter = 0;
    pid_t thread = 0;
};

/// The place in a program (loaded at `program_base`) from which a waiting thread has called the function in which it
/// waits. Null: unknown, or the thread does not wait any more.
void const* place_in_stack(ThreadPlace const& thread, void const* program_base);

// From a place in a program's code to the line of its source; not for signal handlers.

/// "at main.c:31 in compute()" by the debug information of the program's file; "in compute()" by its symbols where
/// there is none; empty where there are none either, or the file has been built again since.
std::string place_in_source(ProgramImage const& image, void const* place);

}  // namespace pogosim
