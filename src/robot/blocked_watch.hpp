// User code that blocks in wall-clock time, as in nanosleep(), read(), or for a lock: the whole run stands still, and
// the watch over processor time (user_watch.cpp) does not see it. A thread of the simulator looks at the threads that
// run user code, four times a second, without disturbing them: a signal would end some calls before their time.
#pragma once

namespace pogosim {

struct RunGuard;

/// The calling thread runs user code for this guard from now on, until end_watch_over_blocked().
void watch_over_blocked(RunGuard& guard);
void end_watch_over_blocked(RunGuard& guard);

}  // namespace pogosim
