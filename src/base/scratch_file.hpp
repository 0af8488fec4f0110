// A file that a run writes next to its data file before replacing it. It must not be left behind, even if the program
// ends in a signal handler.
#pragma once

#include <sys/types.h>

#include <filesystem>

namespace pogosim {

/// Behind the name of a file, that of one which will replace it once it is complete.
inline constexpr auto kUnfinishedSuffix = ".pogosim-new";

/// Removed with this object, and by remove_scratch_files(), if this process made it.
class ScratchFile {
public:
    /// No file.
    ScratchFile() = default;
    /// Registers an existing file.
    explicit ScratchFile(std::filesystem::path path);
    ~ScratchFile() { remove(); }
    ScratchFile(ScratchFile const&) = delete;
    ScratchFile& operator=(ScratchFile const&) = delete;

    /// Gives up the file, which has become a user's file or is gone.
    void release() noexcept;

    void remove() noexcept;

private:
    std::filesystem::path path_;  // empty: none
    pid_t owner_ = 0;
    int slot_ = -1;
};

/// The list of the scratch files of this process. A module that is loaded, and has a copy of this room, shares that of
/// what has loaded it before it makes its first file.
void* scratch_files_of_process() noexcept;
void share_scratch_files(void* list) noexcept;

/// Removes all scratch files of this process. May be called in a signal handler.
void remove_scratch_files() noexcept;

}  // namespace pogosim
