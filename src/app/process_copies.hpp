// What a process that runs in copies of itself asks the system for. process_copies_linux.cpp and
// process_copies_macos.cpp have what differs.
#pragma once

#include <unistd.h>

#include <cstddef>

namespace pogosim {

/// How many entries a folder has; 0 where there is none.
std::ptrdiff_t count_entries(char const* folder);

/// How many threads this process has; 0 if that is not known.
std::ptrdiff_t count_threads();

/// This process, a copy, will be ended as soon as the one that made it ends.
void end_soon_after(pid_t parent);

}  // namespace pogosim
