// Signals that are caught while runs go on, in a process that may be a host's: those of crashes, and of the watch.
//
// A host may step a run thousands of times a second. Taking nine signals, making a stack and timers, and giving
// all back would cost more than such a step. So a host's process keeps them, and a thread of the simulator gives
// the signals back when no step has followed for half a second (let_go_of_signals()). Meanwhile, signals that do
// not concern a run are passed on to the handlers before. A handler that the host installs in the meantime is
// found by the next step, unless that follows within 2 ms. A host that handles alarms itself gets all back after
// each step.
#pragma once

namespace pogosim {

/// While this exists, the calling thread works for runs: their signals are caught, and handlers have a stack that is
/// large enough. May be nested.
class ThreadOfRuns {
public:
    ThreadOfRuns();
    ~ThreadOfRuns();
    ThreadOfRuns(ThreadOfRuns const&) = delete;
    ThreadOfRuns& operator=(ThreadOfRuns const&) = delete;
};

/// From now on the signals are caught, until the call that follows as often. Those of a crash handler's own threads.
void need_signals();
void need_signals_no_more();

/// Called four times a second by a thread of the simulator.
void let_go_of_signals();

// Around fork(): the child of a host has no thread that would give the signals back, and no timers.
void hold_signals_before_fork();
void release_signals_in_parent();
void forget_signals_in_child();

}  // namespace pogosim
