#include "process/process.hpp"

#include <pthread.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>

#include "process/crash_handler_state.hpp"
#include "process/crash_message.hpp"
#include "process/forked_child.hpp"
#include "process/other_threads.hpp"

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

}  // namespace pogosim
