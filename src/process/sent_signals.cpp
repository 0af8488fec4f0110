#include "process/sent_signals.hpp"

#include <array>
#include <csignal>

namespace pogosim {

namespace {

constinit thread_local std::array<std::atomic<int>, 2> counts_of_thread{};

std::size_t index_of(int signal) {
    return signal == SIGALRM ? 0 : 1;
}

}  // namespace

SignalledThread SignalledThread::current() {
    SignalledThread thread;
    thread.thread_ = pthread_self();
    thread.counts_ = counts_of_thread.data();
    return thread;
}

void SignalledThread::send(int signal) const {
    ++counts_[index_of(signal)];  // first: the signal may come at once
    pthread_kill(thread_, signal);
}

bool take_sent_signal(int signal) {
    std::atomic<int>& count = counts_of_thread[index_of(signal)];
    if (count <= 0) {
        return false;
    }
    --count;
    return true;
}

}  // namespace pogosim
