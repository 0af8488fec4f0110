// A program may call fork(). The child is a copy of the whole run, but the data file, the console and the messages are
// the parent's: the child runs its own code and ends quietly, at the latest when that returns to the simulator.
#pragma once

namespace pogosim {

/// Recognises children from now on.
void watch_for_forks();

/// True in a child.
bool is_forked_child();

/// Ends the child: what it printed itself is written out, no handler or destructor of the run is called.
[[noreturn]] void end_forked_child(int status);

}  // namespace pogosim
