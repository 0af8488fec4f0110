#include "tables/complete_file.hpp"

#include <arrow/io/file.h>
#include <arrow/ipc/reader.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/scratch_file.hpp"
#include "record/paths_beside.hpp"
#include "tables/leftover.hpp"
#include "tables/table_memory.hpp"
#include "tables/table_writer.hpp"

namespace pogosim {

using arrow::Status;

namespace {

constexpr auto kKeptSuffix = ".pogosim-kept";
constexpr int kMostKept = 1000;
constexpr std::size_t kCopiedAtOnce = 1U << 20U;
constexpr mode_t kPermissions = 0777;

void sync_folder_of(std::filesystem::path const& path) {
    int const folder = open(path.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder >= 0) {
        fsync(folder);
        close(folder);
    }
}

/// Puts a file in the place of another one, which is gone afterwards; fails with false and errno. A file that is
/// renamed onto another is written to the disk at once by ext4 (auto_da_alloc), and a batch, which removes it soon,
/// waits for milliseconds. A file that need not be synced is exchanged with the other one instead, where the system can
/// do that.
bool put_in_place(std::filesystem::path const& file, std::filesystem::path const& other,
                  [[maybe_unused]] bool is_synced) {
#ifdef RENAME_EXCHANGE
    if (!is_synced && renameat2(AT_FDCWD, file.c_str(), AT_FDCWD, other.c_str(), RENAME_EXCHANGE) == 0) {
        unlink(file.c_str());
        return true;
    }
#endif
    return std::rename(file.c_str(), other.c_str()) == 0;
}

/// Creates a file; fails with -1 and errno if one exists.
int make_file(std::filesystem::path const& path) {
    return open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
}

/// Creates a file with a unique name in the folder for temporary files. Returns its descriptor, or -1 with errno.
int make_temporary_file(std::filesystem::path& path) {
    std::error_code error;
    std::string name = std::filesystem::temp_directory_path(error) / "pogosim-XXXXXX.feather";
    int const descriptor = mkstemps(name.data(), static_cast<int>(std::string_view(".feather").size()));
    if (descriptor >= 0) {
        fcntl(descriptor, F_SETFD, FD_CLOEXEC);
    }
    path = name;
    return descriptor;
}

}  // namespace

CompleteFile::CompleteFile(std::filesystem::path path, int descriptor)
    : path_(std::move(path)),
      descriptor_(descriptor),
      owner_(getpid()),
      stream_(std::make_shared<DescriptorStream>(descriptor)) {
    try_lock(descriptor);  // it will be the data file
    if (!path_.empty()) {
        scratch_.emplace(path_);
    }
}

CompleteFile::~CompleteFile() {
    scratch_.reset();
    if (getpid() == owner_) {
        flock(descriptor_, LOCK_UN);  // children of this process may still have the file open
    }
    close(descriptor_);
}

arrow::Result<std::unique_ptr<CompleteFile>> CompleteFile::make(LockedFile const& unfinished) {
    auto const wrap = [](std::filesystem::path path, int descriptor) {
        return std::unique_ptr<CompleteFile>(new CompleteFile(std::move(path), descriptor));
    };
    auto const usual = complete_file_beside(unfinished.path());
    if (is_leftover(usual)) {
        unlink(usual.c_str());
    }
    std::filesystem::path const other = usual.native() + "-" + std::to_string(getpid());
    for (auto const& path : {usual, other}) {
        if (int const descriptor = make_file(path); descriptor >= 0) {
            return wrap(path, descriptor);
        }
    }
    int const reason = errno;
    std::filesystem::path temporary;
    int const descriptor = make_temporary_file(temporary);
    if (descriptor < 0) {
        return system_error(reason);
    }
    unlink(temporary.c_str());  // it will be copied, and must not outlive the run
    return wrap("", descriptor);
}

arrow::Result<std::unique_ptr<CompleteFile>> CompleteFile::start(LockedFile const& unfinished,
                                                                 std::shared_ptr<arrow::Schema> const& schema,
                                                                 arrow::MemoryPool* memory, TableFormat format) {
    ARROW_ASSIGN_OR_RAISE(auto file, make(unfinished));
    ARROW_ASSIGN_OR_RAISE(file->writer_, make_table_writer(format, file->stream_, schema, memory));
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

arrow::Result<std::unique_ptr<CompleteFile>> CompleteFile::copy_with(std::shared_ptr<arrow::Schema> const& schema,
                                                                     TableFormat format, LockedFile const& unfinished,
                                                                     bool sync) {
    int const duplicate = fcntl(descriptor_, F_DUPFD_CLOEXEC, 0);
    if (duplicate < 0) {
        return system_error(errno);
    }
    ARROW_ASSIGN_OR_RAISE(auto const input, arrow::io::ReadableFile::Open(duplicate));
    auto options = arrow::ipc::IpcReadOptions::Defaults();
    options.use_threads = false;
    ARROW_ASSIGN_OR_RAISE(auto const reader, arrow::ipc::RecordBatchFileReader::Open(input, options));
    // A file without a name is removed with the process.
    scratch_.reset();
    path_.clear();
    ARROW_ASSIGN_OR_RAISE(auto copy, start(unfinished, schema, table_memory(), format));
    for (int i = 0; i < reader->num_record_batches(); ++i) {
        ARROW_ASSIGN_OR_RAISE(auto const batch, reader->ReadRecordBatch(i));
        ARROW_RETURN_NOT_OK(copy->append(*batch));
    }
    ARROW_RETURN_NOT_OK(copy->finish(sync));
    return copy;
}

/// Renaming is only possible if the file then equals the unfinished one to the user: same owner, no other hard link.
bool CompleteFile::can_be_renamed_to(LockedFile const& unfinished) const {
    struct stat mine = {};
    struct stat theirs = {};
    return !path_.empty() && fstat(descriptor_, &mine) == 0 && fstat(unfinished.descriptor(), &theirs) == 0 &&
           theirs.st_nlink <= 1 && mine.st_uid == theirs.st_uid && mine.st_gid == theirs.st_gid &&
           fchmod(descriptor_, theirs.st_mode & kPermissions) == 0;
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
        return Status::IOError("another program replaced it during the run");
    }
    int reason = ENOENT;
    if (can_be_renamed_to(unfinished)) {
        if (put_in_place(path_, unfinished.path(), synced_)) {
            scratch_->release();
            if (synced_) {
                sync_folder_of(unfinished.path());
            }
            return Status::OK();
        }
        reason = errno;
    }
    if (!unfinished.is_still_there()) {
        return system_error(reason);
    }
    return copy_to(unfinished.descriptor());
}

arrow::Result<std::filesystem::path> CompleteFile::keep_beside(LockedFile const& unfinished) {
    for (int i = 1; i <= kMostKept; ++i) {
        std::filesystem::path kept = unfinished.path().native() + kKeptSuffix + (i > 1 ? "-" + std::to_string(i) : "");
        if (!path_.empty() && link(path_.c_str(), kept.c_str()) == 0) {
            return kept;  // the other name goes with this object
        }
        if (int const descriptor = make_file(kept); descriptor >= 0) {
            return copy_to_new(kept, descriptor);
        }
        if (errno != EEXIST) {
            break;
        }
    }
    std::filesystem::path kept;
    int const descriptor = make_temporary_file(kept);
    return descriptor >= 0 ? copy_to_new(kept, descriptor) : system_error(errno);
}

arrow::Result<std::filesystem::path> CompleteFile::copy_to_new(std::filesystem::path const& path,
                                                               int descriptor) const {
    auto const status = copy_to(descriptor);
    close(descriptor);
    if (!status.ok()) {
        unlink(path.c_str());
        return status;
    }
    return path;
}

}  // namespace pogosim
