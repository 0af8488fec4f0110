#include "base/locked_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace pogosim {

namespace {

constexpr int kMostAttempts = 100;  // other runs may replace or remove the file in between
constexpr int kMostLinks = 40;
constexpr mode_t kNewFile = 0666;  // reduced by the umask

}  // namespace

void fail_with_errno(int error_number) {
    throw FileError(std::generic_category().message(error_number));
}

void check_is_name_of_file(std::filesystem::path const& path) {
    if (!path.has_filename() || path.filename() == ".") {
        throw FileError("this is the name of a folder, not of a file");
    }
}

std::filesystem::path real_path(std::filesystem::path const& path) {
    std::error_code error;
    std::filesystem::path target = std::filesystem::absolute(path, error);
    if (error) {
        return path;
    }
    for (int i = 0;
         i < kMostLinks && std::filesystem::is_symlink(target, error) && !std::filesystem::exists(target, error); ++i) {
        auto const next = std::filesystem::read_symlink(target, error);
        if (error) {
            break;
        }
        target = target.parent_path() / next;
    }
    std::filesystem::path real = std::filesystem::weakly_canonical(target, error);
    return error ? target : real;
}

bool try_lock(int descriptor, int kind) {
    while (flock(descriptor, kind | LOCK_NB) != 0) {
        if (errno != EINTR) {
            return errno != EWOULDBLOCK;  // otherwise: no locks on this file system
        }
    }
    return true;
}

LockedFile::LockedFile(std::filesystem::path const& path)
    : path_(path.empty() ? path : real_path(path)), owner_(getpid()) {
    for (int i = 0; i < kMostAttempts; ++i) {
        if (!open_once()) {
            continue;
        }
        if (!try_lock(descriptor_)) {
            made_here_ = false;
            close_file();
            throw FileInUse();
        }
        if (is_still_there()) {
            return;
        }
        made_here_ = false;  // replaced or removed by the run that had it
        close_file();
    }
    throw FileError("other programs keep replacing it");
}

LockedFile::LockedFile(std::filesystem::path path, int descriptor)
    : path_(std::move(path)), descriptor_(fcntl(descriptor, F_DUPFD_CLOEXEC, 0)), owner_(getpid()) {
    if (descriptor_ < 0) {
        fail_with_errno(errno);
    }
    try_lock(descriptor_);
}

bool LockedFile::open_once() {
    descriptor_ = open(path_.c_str(), O_RDWR | O_CLOEXEC);
    if (descriptor_ < 0 && errno == EACCES) {
        descriptor_ = open(path_.c_str(), O_WRONLY | O_CLOEXEC);
    }
    if (descriptor_ < 0 && errno == ENOENT) {
        descriptor_ = open(path_.c_str(), O_RDWR | O_CLOEXEC | O_CREAT | O_EXCL, kNewFile);
        made_here_ = descriptor_ >= 0;
        if (descriptor_ < 0 && errno == EEXIST) {
            return false;
        }
    }
    if (descriptor_ < 0) {
        fail_with_errno(errno);
    }
    return true;
}

bool LockedFile::is_still_there() const {
    struct stat here = {};
    struct stat there = {};
    return fstat(descriptor_, &here) == 0 && stat(path_.c_str(), &there) == 0 && here.st_dev == there.st_dev &&
           here.st_ino == there.st_ino;
}

void LockedFile::close_file() noexcept {
    if (descriptor_ < 0) {
        return;
    }
    if (getpid() == owner_) {
        if (made_here_ && is_still_there()) {
            unlink(path_.c_str());
        }
        flock(descriptor_, LOCK_UN);  // children of this process may still have the file open
    }
    close(descriptor_);
    descriptor_ = -1;
}

LockedFile::~LockedFile() {
    close_file();
}

LockedFile::LockedFile(LockedFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      made_here_(other.made_here_),
      owner_(other.owner_) {}

LockedFile& LockedFile::operator=(LockedFile&& other) noexcept {
    if (this != &other) {
        close_file();
        path_ = std::move(other.path_);
        descriptor_ = std::exchange(other.descriptor_, -1);
        made_here_ = other.made_here_;
        owner_ = other.owner_;
    }
    return *this;
}

}  // namespace pogosim
