// Signals that this process sends to a thread of its own, which a handler tells from those of others: of an alarm that
// the user's program has set, for one.
#pragma once

#include <pthread.h>

#include <atomic>

namespace pogosim {

/// A thread to which signals are sent, as long as it lives.
class SignalledThread {
public:
    SignalledThread() = default;
    static SignalledThread current();

    pthread_t id() const { return thread_; }
    bool is_current() const { return counts_ != nullptr && pthread_equal(thread_, pthread_self()) != 0; }

    /// Sends it SIGALRM or SIGPROF. For signal handlers, too.
    void send(int signal) const;

private:
    pthread_t thread_{};
    std::atomic<int>* counts_ = nullptr;  // of its SIGALRM and its SIGPROF that were sent and not taken
};

/// For handlers of SIGALRM and SIGPROF: whether such a signal was sent to this thread. Each one counts once; where
/// several come as one, an alarm of others that comes later is taken for one of them.
bool take_sent_signal(int signal);

}  // namespace pogosim
