#include "base/new_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <random>
#include <string>
#include <string_view>
#include <system_error>

namespace pogosim {

namespace {

namespace fs = std::filesystem;

constexpr mode_t kPermissions = 0777;

void must_succeed(int result) {
    if (result != 0) {
        fail_with_errno(errno);
    }
}

}  // namespace

void write_all(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        ssize_t const written = write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno != EINTR) {
            fail_with_errno(errno);
        }
        bytes.remove_prefix(written < 0 ? 0 : static_cast<std::size_t>(written));
    }
}

void make_parent_folder(fs::path const& path) {
    std::error_code error;
    if (!path.parent_path().empty() && !fs::create_directories(path.parent_path(), error) && error) {
        throw FileError(fmt::format("cannot make the folder '{}': {}", path.parent_path().string(), error.message()));
    }
}

NewFile::NewFile(fs::path const& target) : target_(target) {
    constexpr mode_t kNewFile = 0666;  // reduced by the umask
    constexpr int kMostAttempts = 100;
    std::random_device nonce;
    for (int i = 0; i < kMostAttempts && descriptor_ < 0 && (i == 0 || errno == EEXIST); ++i) {
        path_ = fmt::format("{}.tmp.{:08x}", target.native(), nonce());
        descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kNewFile);
    }
    if (descriptor_ < 0) {
        fail_with_errno(errno);
    }
    scratch_.emplace(path_);
}

void NewFile::remove_unfinished(fs::path const& target) {
    constexpr std::string_view kHex = "0123456789abcdef";
    constexpr std::size_t kDigits = 8;
    std::string const stem = target.filename().native() + ".tmp.";
    std::error_code error;
    fs::path const folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    for (fs::directory_entry const& entry : fs::directory_iterator(folder, error)) {
        std::string const name = entry.path().filename().native();
        if (name.size() == stem.size() + kDigits && name.starts_with(stem) &&
            name.find_first_not_of(kHex, stem.size()) == std::string::npos) {
            fs::remove(entry.path(), error);
        }
    }
}

NewFile::~NewFile() {
    scratch_.reset();
    close(descriptor_);
}

void NewFile::replace(LockedFile const& other) {
    struct stat before = {};
    must_succeed(fstat(other.descriptor(), &before));
    must_succeed(fchmod(descriptor_, before.st_mode & kPermissions));
    must_succeed(fsync(descriptor_));
    must_succeed(std::rename(path_.c_str(), target_.c_str()));
    scratch_->release();
    sync_folder();
}

void NewFile::take_free_place() {
    must_succeed(fsync(descriptor_));
    if (link(path_.c_str(), target_.c_str()) != 0 && errno != EEXIST) {  // some file systems have no links
        must_succeed(std::rename(path_.c_str(), target_.c_str()));
        scratch_->release();
    }
    sync_folder();
}

void NewFile::sync_folder() const {
    int const folder = open(target_.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder >= 0) {
        fsync(folder);
        close(folder);
    }
}

}  // namespace pogosim
