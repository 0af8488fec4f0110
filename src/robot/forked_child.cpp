#include "robot/forked_child.hpp"

#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>

#include "base/log.hpp"
#include "robot/caught_signals.hpp"

namespace pogosim {

namespace {

std::atomic<bool> forked = false;

/// Else the child would have a copy of what the parent has not written yet, and write it as well.
void before_fork() {
    std::fflush(nullptr);
}

void in_child() {
    forked = true;
    silence_logs();
    release_caught_signals();
}

}  // namespace

void watch_for_forks() {
    pthread_atfork(before_fork, nullptr, in_child);
}

bool is_forked_child() {
    return forked.load(std::memory_order_relaxed);
}

void end_forked_child(int status) {
    std::fflush(nullptr);
    _exit(status);
}

}  // namespace pogosim
