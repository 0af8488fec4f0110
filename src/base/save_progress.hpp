// How far the data file has got on its way to the disk, for whoever waits for it.
#pragma once

#include <atomic>
#include <cstdint>

namespace pogosim {

struct SaveProgress {
    std::atomic<std::uint64_t> bytes = 0;   // not compressed, of all rows of the file that is being completed
    std::atomic<std::uint64_t> writes = 0;  // each piece that the system has taken
};

inline SaveProgress& save_progress() {
    static SaveProgress progress;
    return progress;
}

}  // namespace pogosim
