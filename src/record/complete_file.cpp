#include "record/complete_file.hpp"

#include <arrow/util/compression.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "base/scratch_file.hpp"

namespace pogosim {

using arrow::Status;

namespace {

constexpr auto kSuffix = ".pogosim-new";
constexpr std::size_t kCopiedAtOnce = 1U << 20U;
constexpr mode_t kPermissions = 0777;

void sync_folder_of(std::filesystem::path const& path) {
    int const folder = open(path.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder >= 0) {
        fsync(folder);
        close(folder);
    }
}

}  // namespace

CompleteFile::CompleteFile(std::filesystem::path path, int descriptor)
    : path_(std::move(path)),
      descriptor_(descriptor),
      owner_(getpid()),
      stream_(std::make_shared<DescriptorStream>(descriptor)) {
    remember_scratch_file(path_);
}

CompleteFile::~CompleteFile() {
    if (temporary_) {
        remove_scratch_file();
    }
    if (getpid() == owner_) {
        flock(descriptor_, LOCK_UN);  // children of this process may still have the file open
    }
    close(descriptor_);
}

arrow::Result<std::unique_ptr<CompleteFile>> CompleteFile::make(std::filesystem::path const& path) {
    unlink(path.c_str());  // of a run that was killed
    int const descriptor = open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
    if (descriptor < 0) {
        return system_error(errno);
    }
    try_lock(descriptor);  // it will be the data file
    return std::unique_ptr<CompleteFile>(new CompleteFile(path, descriptor));
}

arrow::Result<std::unique_ptr<CompleteFile>> CompleteFile::start(LockedFile const& unfinished,
                                                                 std::shared_ptr<arrow::Schema> const& schema) {
    auto made = make(unfinished.path().native() + kSuffix);
    if (!made.ok()) {
        std::error_code error;
        auto const elsewhere = std::filesystem::temp_directory_path(error);
        auto const name = unfinished.path().filename().native() + "-" + std::to_string(getpid()) + kSuffix;
        auto other = make(elsewhere / name);
        if (error || !other.ok()) {
            return made.status();
        }
        made = std::move(other);
    }
    auto file = std::move(made).ValueUnsafe();
    auto options = arrow::ipc::IpcWriteOptions::Defaults();
    ARROW_ASSIGN_OR_RAISE(options.codec, arrow::util::Codec::Create(arrow::Compression::ZSTD));
    options.use_threads = false;  // the process stays single-threaded
    ARROW_ASSIGN_OR_RAISE(file->writer_, arrow::ipc::MakeFileWriter(file->stream_, schema, options));
    return file;
}

Status CompleteFile::finish(bool sync) {
    ARROW_RETURN_NOT_OK(writer_->Close());
    ARROW_RETURN_NOT_OK(stream_->Flush());
    if (sync && fsync(descriptor_) != 0) {
        return system_error(errno);
    }
    synced_ = sync;
    return Status::OK();
}

/// A renamed file must be to the user what the unfinished one was: same owner, and no other name leads to it.
bool CompleteFile::can_be_renamed_to(LockedFile const& unfinished) const {
    struct stat mine = {};
    struct stat theirs = {};
    return path_.parent_path() == unfinished.path().parent_path() && fstat(descriptor_, &mine) == 0 &&
           fstat(unfinished.descriptor(), &theirs) == 0 && theirs.st_nlink <= 1 && mine.st_uid == theirs.st_uid &&
           mine.st_gid == theirs.st_gid && fchmod(descriptor_, theirs.st_mode & kPermissions) == 0;
}

Status CompleteFile::copy_to(int descriptor) const {
    std::vector<char> bytes(kCopiedAtOnce);
    DescriptorStream target(descriptor);
    int64_t position = 0;
    while (true) {
        ssize_t const count = pread(descriptor_, bytes.data(), bytes.size(), position);
        if (count < 0 && errno == EINTR) {
            continue;
        }
        if (count < 0) {
            return system_error(errno);
        }
        if (count == 0) {
            break;
        }
        ARROW_RETURN_NOT_OK(target.Write(bytes.data(), count));
        position += count;
    }
    ARROW_RETURN_NOT_OK(target.Flush());
    if (ftruncate(descriptor, position) != 0 || (synced_ && fsync(descriptor) != 0)) {
        return system_error(errno);
    }
    return Status::OK();
}

Status CompleteFile::take_the_place_of(LockedFile const& unfinished) {
    std::error_code error;
    if (!unfinished.is_still_there() && std::filesystem::exists(unfinished.path(), error)) {
        return Status::IOError("another program has replaced it during the run");
    }
    if (can_be_renamed_to(unfinished) && std::rename(path_.c_str(), unfinished.path().c_str()) == 0) {
        keep();
        if (synced_) {
            sync_folder_of(unfinished.path());
        }
        return Status::OK();
    }
    int const reason = errno;
    return unfinished.is_still_there() ? copy_to(unfinished.descriptor()) : system_error(reason);
}

void CompleteFile::keep() {
    temporary_ = false;
    forget_scratch_file();
}

}  // namespace pogosim
