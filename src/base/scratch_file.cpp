#include "base/scratch_file.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <climits>
#include <cstring>

namespace pogosim {

namespace {

struct Scratch {
    std::array<char, PATH_MAX> path{};  // plain memory: the heap may be destroyed
    std::atomic<pid_t> owner = 0;       // 0: no file
};

Scratch scratch;

}  // namespace

void remember_scratch_file(std::filesystem::path const& path) {
    forget_scratch_file();
    if (path.native().size() < scratch.path.size()) {
        std::strcpy(scratch.path.data(), path.c_str());
        scratch.owner = getpid();
    }
}

void forget_scratch_file() {
    scratch.owner = 0;
}

void remove_scratch_file() noexcept {
    if (scratch.owner.exchange(0) == getpid()) {
        unlink(scratch.path.data());
    }
}

}  // namespace pogosim
