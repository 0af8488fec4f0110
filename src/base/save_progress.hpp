// Progress of writing the data file, for the watchdog of a run that is ending.
#pragma once

#include <atomic>
#include <cstdint>

namespace pogosim {

struct SaveProgress {
    std::atomic<std::uint64_t> bytes = 0;   // uncompressed, of all rows of the file that is being completed
    std::atomic<std::uint64_t> writes = 0;  // number of successful write calls
};

inline SaveProgress& save_progress() {
    static SaveProgress progress;
    return progress;
}

}  // namespace pogosim
