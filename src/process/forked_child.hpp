// A program may call fork(). The child is a copy of the whole run, but the data file, the console and the messages are
// the parent's: the child runs its own code and ends quietly, at the latest when that returns to the simulator.
#pragma once

namespace pogosim {

/// Detects children from now on.
void watch_for_forks();

/// True in a child.
bool is_forked_child();

/// Ends the child: flushes its own output, without calling any handler or destructor of the run.
[[noreturn]] void end_forked_child(int status);

}  // namespace pogosim
