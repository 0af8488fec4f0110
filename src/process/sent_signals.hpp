// Signals that this process sends to a thread of its own, which a handler tells from those of others: of an alarm that
// the user's program has set, for one.
#pragma once

#include <pthread.h>

namespace pogosim {

/// Signals that were sent to a thread and not taken by it.
struct UntakenSignals;

/// A thread to which signals are sent, as long as it lives.
class SignalledThread {
public:
    SignalledThread() = default;
    static SignalledThread current();

    pthread_t id() const { return thread_; }
    bool is_current() const { return untaken_ != nullptr && pthread_equal(thread_, pthread_self()) != 0; }

    /// Sends it SIGALRM or SIGPROF. For signal handlers, too.
    void send(int signal) const;

private:
    pthread_t thread_{};
    UntakenSignals* untaken_ = nullptr;
};

/// Whether SignalledThread::current() was called in this thread, or in one that had its id and has ended. For handlers:
/// if not, no signal of ours is for this thread, and its thread-local variables may be unused; macOS allocates them at
/// their first use.
bool is_signalled_thread();

/// For handlers of SIGALRM and SIGPROF: whether such a signal was sent to this thread. Each one counts once. If two
/// merge, a later alarm of the user's is taken for ours.
bool take_sent_signal(int signal);

}  // namespace pogosim
