#include "render/frame_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "base/scratch_file.hpp"
#include "render/png_file.hpp"

namespace pogosim {

FrameLock::FrameLock(FrameNames const& names, bool deletes) : owner_(getpid()) {
    std::filesystem::path const first = names.at(0.0);
    std::error_code ignored;
    std::filesystem::create_directories(first.parent_path(), ignored);
    try {
        names_ = LockedFile(first.native() + kUnfinishedSuffix);
    } catch (FileInUse const&) {
        conflict_ = FrameConflict::same_names;
        return;
    }
    if (auto const folder = names.folder()) {
        folder_ = open(folder->c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (folder_ < 0) {
            fail_with_errno(errno);
        }
        if (!try_lock(folder_, deletes ? LOCK_EX : LOCK_SH)) {
            conflict_ = deletes ? FrameConflict::others_draw : FrameConflict::other_deletes;
        }
    }
}

FrameLock::~FrameLock() {
    if (folder_ >= 0) {
        if (getpid() == owner_) {
            flock(folder_, LOCK_UN);  // children of this process may still have the folder open
        }
        close(folder_);
    }
    std::error_code error;
    if (names_.descriptor() >= 0 && getpid() == owner_ && names_.is_still_there() &&
        std::filesystem::file_size(names_.path(), error) == 0 && !error) {
        unlink(names_.path().c_str());  // also one that a killed run has left
        if (folder_ < 0) {
            std::filesystem::remove(names_.path().parent_path(), error);  // that of t = 0, unless there is a frame
        }
    }
}

void FrameLock::share_folder() const {
    if (folder_ >= 0) {
        try_lock(folder_, LOCK_SH);
    }
}

}  // namespace pogosim
