// Reporting a crash in a thread requires a separate stack for the handler, as the thread's own may be full. The thread
// of the simulator does not end by itself.
#pragma once

namespace pogosim {

/// For the thread that calls main(). Threads that the program starts prepare themselves.
void prepare_main_thread_for_crashes();

/// For a thread that works for a run: from now on, the thread's signal handlers have a large enough stack, until the
/// host gives it another one.
void use_large_signal_stack();

}  // namespace pogosim
