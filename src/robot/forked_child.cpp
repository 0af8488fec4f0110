#include "robot/forked_child.hpp"

#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>

#include "base/log.hpp"
#include "robot/crash_name.hpp"

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
    for (int const signal : kCrashSignals) {
        std::signal(signal, SIG_DFL);
    }
    for (int const signal : {SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGPROF, SIGALRM, SIGPIPE, SIGXFSZ}) {
        std::signal(signal, SIG_DFL);
    }
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
