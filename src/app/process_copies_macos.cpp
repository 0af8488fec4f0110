#include <mach/mach.h>
#include <sys/event.h>

#include <cstdint>
#include <cstdlib>

#include "app/process_copies.hpp"
#include "base/background_thread.hpp"
#include "process/process.hpp"

namespace pogosim {

std::ptrdiff_t count_threads() {
    thread_act_array_t threads = nullptr;
    mach_msg_type_number_t count = 0;
    if (task_threads(mach_task_self(), &threads, &count) != KERN_SUCCESS) {
        return 0;
    }
    for (mach_msg_type_number_t i = 0; i < count; ++i) {
        mach_port_deallocate(mach_task_self(), threads[i]);
    }
    vm_deallocate(mach_task_self(), reinterpret_cast<vm_address_t>(threads), count * sizeof(*threads));
    return count;
}

void end_soon_after(pid_t parent) {
    start_background_thread("waiting for the end of the server", [parent] {
        int const queue = kqueue();
        struct kevent end = {};
        EV_SET(&end, static_cast<uintptr_t>(parent), EVFILT_PROC, EV_ADD, NOTE_EXIT, 0, nullptr);
        if (queue >= 0 && kevent(queue, &end, 1, &end, 1, nullptr) > 0) {
            end_process(EXIT_FAILURE);
        }
    }).detach();
}

}  // namespace pogosim
