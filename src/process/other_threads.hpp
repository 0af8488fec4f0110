// Reporting a crash in a thread requires a separate stack for the handler, as the thread's own may be full. The thread
// of the simulator does not end by itself.
#pragma once

#include <csignal>

namespace pogosim {

/// For the thread that calls main(). Threads that the program starts prepare themselves.
void prepare_main_thread_for_crashes();

/// For a thread that works for a run: while this exists, the thread's signal handlers have a large enough stack. A
/// stack that the host had given it, which may be small, is restored afterwards.
class SignalStackScope {
public:
    SignalStackScope();
    ~SignalStackScope();
    SignalStackScope(SignalStackScope const&) = delete;
    SignalStackScope& operator=(SignalStackScope const&) = delete;

private:
    stack_t before_{};
    bool is_switched_ = false;
};

}  // namespace pogosim
