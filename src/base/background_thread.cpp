#include "base/background_thread.hpp"

#include <pthread.h>

#include <atomic>
#include <csignal>
#include <utility>

#include "base/floating_point.hpp"

namespace pogosim {

namespace {

thread_local char const* activity_of_thread = nullptr;
std::atomic<bool> has_crashed = false;

/// As long as this lives, the thread takes no signals, and neither do those it starts.
class BlockedSignals {
public:
    BlockedSignals() {
        sigset_t blocked;
        sigfillset(&blocked);
        for (int const signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS}) {
            sigdelset(&blocked, signal);  // a thread sends these to itself
        }
        pthread_sigmask(SIG_BLOCK, &blocked, &before_);
    }
    ~BlockedSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    BlockedSignals(BlockedSignals const&) = delete;
    BlockedSignals& operator=(BlockedSignals const&) = delete;

private:
    sigset_t before_{};
};

}  // namespace

std::thread start_background_thread(char const* activity, std::function<void()> body) {
    BlockedSignals const during_the_start;  // threads inherit the mask
    return std::thread([activity, body = std::move(body)] {
        activity_of_thread = activity;
        StandardFloatingPoint const mode;  // threads inherit that, too
        body();
    });
}

char const* background_activity() {
    return activity_of_thread;
}

void note_crash_of_background_thread() {
    has_crashed = true;
}

bool has_background_thread_crashed() {
    return has_crashed;
}

}  // namespace pogosim
