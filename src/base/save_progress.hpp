// Progress of writing the data file, for the watchdog of a run that is ending.
#pragma once

#include <atomic>
#include <cstdint>

namespace pogosim {

struct SaveProgress {
    std::atomic<std::uint64_t> bytes = 0;   // uncompressed, of all rows of the file that is being completed
    std::atomic<std::uint64_t> writes = 0;  // number of successful write calls
};

inline constinit SaveProgress own_save_progress;
inline constinit std::atomic<SaveProgress*> shared_save_progress = &own_save_progress;

inline SaveProgress& save_progress() {
    return *shared_save_progress;
}

/// For a module that is loaded, and has one of its own: it shares that of what has loaded it.
inline void share_save_progress(SaveProgress& progress) {
    shared_save_progress = &progress;
}

}  // namespace pogosim
