#include "base/scratch_file.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <climits>
#include <cstring>
#include <utility>

namespace pogosim {

namespace {

// Static memory for signal handlers, since the heap may be corrupted. Further files are removed by their objects only.
constexpr int kSlots = 64;
struct Slot {
    std::atomic<bool> taken = false;
    std::atomic<pid_t> owner = 0;  // 0: no file
    std::array<char, PATH_MAX> path{};
};
using Slots = std::array<Slot, kSlots>;
Slots own_slots;
constinit std::atomic<Slots*> shared_slots = &own_slots;
static_assert(std::atomic<Slots*>::is_always_lock_free);

Slots& slots() {
    return *shared_slots;
}

int register_path(std::filesystem::path const& path, pid_t owner) {
    if (path.native().size() >= PATH_MAX) {
        return -1;
    }
    for (int i = 0; i < kSlots; ++i) {
        Slot& slot = slots().at(static_cast<std::size_t>(i));
        if (!slot.taken.exchange(true)) {
            std::strcpy(slot.path.data(), path.c_str());
            slot.owner = owner;
            return i;
        }
    }
    return -1;
}

}  // namespace

ScratchFile::ScratchFile(std::filesystem::path path)
    : path_(std::move(path)), owner_(getpid()), slot_(register_path(path_, owner_)) {}

void ScratchFile::release() noexcept {
    if (slot_ >= 0) {
        Slot& slot = slots().at(static_cast<std::size_t>(slot_));
        slot.owner = 0;
        slot.taken = false;
        slot_ = -1;
    }
    path_.clear();
}

void ScratchFile::remove() noexcept {
    if (!path_.empty() && owner_ == getpid()) {
        unlink(path_.c_str());
    }
    release();
}

void* scratch_files_of_process() noexcept {
    return shared_slots;
}

void share_scratch_files(void* list) noexcept {
    shared_slots = static_cast<Slots*>(list);
}

void remove_scratch_files() noexcept {
    for (Slot& slot : slots()) {
        if (slot.owner.exchange(0) == getpid()) {
            unlink(slot.path.data());
        }
    }
}

}  // namespace pogosim
