// Files that a run writes: where a path really leads, and a lock that keeps a second run from writing the same file.
#pragma once

#include <sys/file.h>
#include <sys/types.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace pogosim {

/// A file cannot be opened, locked or written; the message gives the reason, without the name of the file.
class FileError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Another run has locked it.
class FileInUse : public FileError {
public:
    FileInUse() : FileError("in use by another run; wait for it to finish, or give each run its own file") {}
};

/// Throws FileError with the system's text for `error_number` (errno).
[[noreturn]] void fail_with_errno(int error_number);

/// Throws FileError for the name of a folder, such as "results/", which can be no file.
void check_is_name_of_file(std::filesystem::path const& path);

/// The absolute path without symbolic links, "." and ".."; components that do not exist yet are kept unchanged.
/// Dangling links are also followed.
std::filesystem::path real_path(std::filesystem::path const& path);

/// An open file that no other run can open this way until it is closed. The contents are left untouched, since a file
/// is locked before it is truncated. On file systems without locks, there is none. It belongs to the process that
/// opened it: a forked child only closes its copy.
class LockedFile {
public:
    LockedFile() = default;  // no file

    /// Opens or creates the file for writing. Throws FileError; FileInUse if another run has locked it.
    explicit LockedFile(std::filesystem::path const& path);

    /// Locks an open file that is about to get this path. Throws FileError.
    LockedFile(std::filesystem::path path, int descriptor);

    /// Releases the lock. A file that was made here is removed again unless keep() was called.
    ~LockedFile();

    LockedFile(LockedFile&& other) noexcept;
    LockedFile& operator=(LockedFile&& other) noexcept;

    /// Keeps a file that was created here.
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

/// Locks an open file or folder (LOCK_EX: alone, LOCK_SH: with others that do so); false if another run has a lock that
/// does not allow it, true also if locks are not supported.
bool try_lock(int descriptor, int kind = LOCK_EX);

}  // namespace pogosim
