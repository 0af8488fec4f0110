// User code that blocks in wall-clock time, as in nanosleep(), read(), or for a lock: the whole run stands still, and
// the watch over processor time (watchdog.cpp) does not see it. A thread of the simulator looks at the threads that
// run user code, four times a second, without disturbing them: a signal would end some calls before their time.
#pragma once

namespace pogosim {

struct CrashHandlerState;

/// The calling thread runs user code for this handler from now on, until end_watch_over_blocked().
void watch_over_blocked(CrashHandlerState& handler);
void end_watch_over_blocked(CrashHandlerState& handler);

}  // namespace pogosim
