#include "process/forked_child.hpp"

#include <dlfcn.h>
#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>

#include "base/log.hpp"
#include "process/caught_signals.hpp"
#include "process/crash_handler_state.hpp"
#include "process/crash_message.hpp"
#include "process/process.hpp"

namespace pogosim {

namespace {

std::atomic<bool> forked = false;

/// Otherwise the child would inherit the parent's unwritten output and also write it.
void before_fork() {
    if (process_is_ours() || active_handler != nullptr) {
        std::fflush(nullptr);
    }
}

void in_child() {
    if (!process_is_ours() && active_handler == nullptr) {
        return;  // a child of the host's own
    }
    forked = true;
    if (run_stage() != RunStage::finished) {  // else the logs may be gone
        silence_logs();
    }
    release_caught_signals();
}

}  // namespace

void watch_for_forks() {
    static int const registered = pthread_atfork(before_fork, nullptr, in_child);
    static_cast<void>(registered);
}

bool is_forked_child() {
    return forked.load(std::memory_order_relaxed);
}

void end_forked_child(int status) {
    std::fflush(nullptr);
    end_process(status);
}

}  // namespace pogosim

#ifdef __GLIBC__
#if __GLIBC_PREREQ(2, 34)

/// Replaces the C library's function, and calls it: this library stands before libc in the search order. After the run,
/// handlers that libraries have registered with pthread_atfork() may wait for ever for locks that their destructors
/// have destroyed (Arrow's do), so the child is made without them.
extern "C" __attribute__((visibility("default"))) pid_t fork() noexcept {
    using namespace pogosim;
    if (run_stage() != RunStage::finished) {
        static auto const usual_fork = reinterpret_cast<pid_t (*)()>(dlsym(RTLD_NEXT, "fork"));
        return usual_fork();
    }
    before_fork();
    pid_t const child = _Fork();
    if (child == 0) {
        in_child();
    }
    return child;
}

#endif
#endif
