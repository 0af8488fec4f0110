#include "process/sent_signals.hpp"

#include <array>
#include <atomic>
#include <csignal>

namespace pogosim {

/// In a list that only grows, since handlers may look through it at any time. Systems use the ids of threads that have
/// ended again.
struct UntakenSignals {
    pthread_t thread;
    UntakenSignals* next;
    std::array<std::atomic<int>, 2> counts{};

    std::atomic<int>& count(int signal) { return counts[signal == SIGALRM ? 0 : 1]; }
};

namespace {

constinit std::atomic<UntakenSignals*> first = nullptr;

/// Null: this thread has none. Does without thread-local variables, see is_signalled_thread().
UntakenSignals* find_untaken() {
    UntakenSignals* untaken = first;
    while (untaken != nullptr && pthread_equal(untaken->thread, pthread_self()) == 0) {
        untaken = untaken->next;
    }
    return untaken;
}

UntakenSignals* find_or_add_untaken() {
    if (UntakenSignals* const of_ended = find_untaken()) {
        for (std::atomic<int>& count : of_ended->counts) {
            count = 0;
        }
        return of_ended;
    }
    auto* const added = new UntakenSignals{.thread = pthread_self(), .next = first};
    while (!first.compare_exchange_weak(added->next, added)) {
    }
    return added;
}

}  // namespace

SignalledThread SignalledThread::current() {
    static constinit thread_local UntakenSignals* untaken = nullptr;
    if (untaken == nullptr) {
        untaken = find_or_add_untaken();
    }
    SignalledThread thread;
    thread.thread_ = pthread_self();
    thread.untaken_ = untaken;
    return thread;
}

void SignalledThread::send(int signal) const {
    ++untaken_->count(signal);  // first: the signal may come at once
    pthread_kill(thread_, signal);
}

bool is_signalled_thread() {
    return find_untaken() != nullptr;
}

bool take_sent_signal(int signal) {
    UntakenSignals* const untaken = find_untaken();
    if (untaken == nullptr || untaken->count(signal) <= 0) {
        return false;
    }
    --untaken->count(signal);
    return true;
}

}  // namespace pogosim
