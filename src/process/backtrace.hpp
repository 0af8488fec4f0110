// Where in a program's code a crash or a refused call came from.
#pragma once

namespace pogosim {

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

}  // namespace pogosim
