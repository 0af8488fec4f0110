// Files that a run writes: where a path really leads, and a lock that keeps a second run from writing the same file.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace pogosim {

/// A file cannot be opened, locked or written; says why, without the name of the file.
class FileError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Throws FileError with the system's text for `error_number` (errno).
[[noreturn]] void fail_with_errno(int error_number);

/// The path without symbolic links, "." and "..", absolute; what is not there yet is kept as it is written. Links whose
/// target is not there are followed, too.
std::filesystem::path real_path(std::filesystem::path const& path);

/// An open file that no other run can open this way until this one is closed. What the file holds is left alone: the
/// lock comes first, truncating later. Where the file system knows no locks, there is none. Belongs to the process that
/// opened it: a child after fork() closes its copy and no more.
class LockedFile {
public:
    LockedFile() = default;  // no file

    /// Opens the file for writing, or makes it. Throws FileError, also when another run has it.
    explicit LockedFile(std::filesystem::path const& path);

    /// Releases the lock. A file that was made here is removed again unless keep() was called.
    ~LockedFile();

    LockedFile(LockedFile&& other) noexcept;
    LockedFile& operator=(LockedFile&& other) noexcept;

    /// The file is wanted from now on.
    void keep() { made_here_ = false; }

    int descriptor() const { return descriptor_; }               // -1: no file
    std::filesystem::path const& path() const { return path_; }  // the real one

    /// True as long as the path leads to the file that was opened.
    bool is_still_there() const;

private:
    bool open_once();
    void close_file() noexcept;

    std::filesystem::path path_;
    int descriptor_ = -1;
    bool made_here_ = false;
    pid_t owner_ = 0;
};

/// Takes the lock of an open file; false when somebody else has it, true also where there are no locks.
bool try_lock(int descriptor);

}  // namespace pogosim
