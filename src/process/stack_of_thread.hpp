// The stack of another thread of this process, one that waits in the kernel.
#pragma once

#include <sys/types.h>

#include <cstdint>

namespace pogosim {

/// As /proc/self/task/THREAD/syscall shows it.
struct ThreadPlace {
    std::uintptr_t stack_pointer = 0;
    std::uintptr_t program_counter = 0;
    pid_t thread = 0;
};

/// The place in a program (loaded at `program_base`) from which a waiting thread has called the function in which it
/// waits. Null: unknown, or the thread does not wait any more.
void const* place_in_stack(ThreadPlace const& thread, void const* program_base);

}  // namespace pogosim
