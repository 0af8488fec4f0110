#include "tables/leftover.hpp"

#include <arrow/buffer.h>
#include <arrow/io/file.h>
#include <arrow/ipc/reader.h>
#include <arrow/util/key_value_metadata.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <string>
#include <string_view>

#include "base/locked_file.hpp"
#include "tables/unfinished_file.hpp"

namespace pogosim {

namespace {

constexpr std::string_view kFooterEnd = "ARROW1";
constexpr std::string_view kParquet = "PAR1";         // at the beginning, and at the end of a complete file
constexpr std::string_view kCsvHeader = "\"time\",";  // missing if a run records no times; its leftover is then kept

class OpenFile {
public:
    explicit OpenFile(std::filesystem::path const& path)
        : descriptor_(open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC)) {}
    ~OpenFile() {
        if (descriptor_ >= 0) {
            close(descriptor_);
        }
    }
    OpenFile(OpenFile const&) = delete;
    OpenFile& operator=(OpenFile const&) = delete;

    int descriptor() const { return descriptor_; }

private:
    int descriptor_;
};

bool ends_with(int descriptor, off_t size, std::string_view expected) {
    std::string end(expected.size(), '\0');
    auto const count = pread(descriptor, end.data(), end.size(), size - static_cast<off_t>(end.size()));
    return count != static_cast<ssize_t>(end.size()) || end == expected;
}

bool begins_with(int descriptor, std::string_view expected) {
    std::string begin(expected.size(), '\0');
    auto const count = pread(descriptor, begin.data(), begin.size(), 0);
    return count == static_cast<ssize_t>(begin.size()) && begin == expected;
}

bool begins_like_ours(std::filesystem::path const& path) {
    auto const file = arrow::io::ReadableFile::Open(path.native());
    if (!file.ok()) {
        return false;
    }
    auto const magic = (*file)->Read(static_cast<int64_t>(kFileMagic.size()));
    if (!magic.ok() || (*magic)->ToString() != kFileMagic) {
        return false;
    }
    auto const reader = arrow::ipc::RecordBatchStreamReader::Open(*file);
    if (!reader.ok()) {
        return false;
    }
    auto const metadata = (*reader)->schema()->metadata();
    return metadata && metadata->Contains("program_version") && !metadata->Contains(kIncompleteKey);
}

}  // namespace

bool is_leftover(std::filesystem::path const& path) {
    OpenFile const file(path);
    struct stat found = {};
    if (file.descriptor() < 0 || fstat(file.descriptor(), &found) != 0 || !S_ISREG(found.st_mode) ||
        found.st_nlink != 1 || !try_lock(file.descriptor())) {
        return false;
    }
    int const descriptor = file.descriptor();
    bool const is_parquet = begins_with(descriptor, kParquet) && !ends_with(descriptor, found.st_size, kParquet);
    return found.st_size == 0 || is_parquet || begins_with(descriptor, kCsvHeader) ||
           (!ends_with(descriptor, found.st_size, kFooterEnd) && begins_like_ours(path));
}

}  // namespace pogosim
