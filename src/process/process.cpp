#include "process/process.hpp"

#include <dlfcn.h>
#include <pthread.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/syscall.h>
#endif

#include <atomic>
#include <cstdio>

#include "base/log.hpp"
#include "process/caught_signals.hpp"
#include "process/crash_handler_state.hpp"
#include "process/crash_message.hpp"
#include "process/other_threads.hpp"
#include "process/signals_of_runs.hpp"

namespace pogosim {

namespace {

std::atomic<bool> is_ours = false;
pthread_t main_thread{};

}  // namespace

void take_process() {
    main_thread = pthread_self();
    is_ours = true;
    enter_stage(RunStage::before_main);
    prepare_main_thread_for_crashes();
    catch_crashes_of_process();
    watch_for_forks();
}

bool process_is_ours() {
    return is_ours;
}

bool on_main_thread() {
    return is_ours && pthread_equal(pthread_self(), main_thread) != 0;
}

void end_process(int code) {
#ifdef __linux__
    syscall(SYS_exit_group, kOwnEnd | (static_cast<unsigned>(code) & kExitCodeBits));
#endif
    _exit(code);
}

namespace {

std::atomic<bool> forked = false;
bool forks_executable = false;

/// Otherwise the child would inherit the parent's unwritten output and also write it.
void before_fork() {
    hold_signals_before_fork();
    if (process_is_ours() || active_handler != nullptr) {
        std::fflush(nullptr);
    }
}

void in_child() {
    forget_signals_in_child();
    forget_blocked_in_child();
    if (forks_executable) {
        return;
    }
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
    static int const registered = pthread_atfork(before_fork, release_signals_in_parent, in_child);
    static_cast<void>(registered);
}

bool is_forked_child() {
    return forked.load(std::memory_order_relaxed);
}

pid_t fork_executable() {
    forks_executable = true;
    pid_t const child = fork();
    forks_executable = false;
    return child;
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
