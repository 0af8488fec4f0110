#include "tables/descriptor_stream.hpp"

#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "base/save_progress.hpp"

namespace pogosim {

namespace {

constexpr std::size_t kMostGathered = 1U << 20U;  // bytes

}  // namespace

arrow::Status system_error(int error_number) {
    return arrow::Status::IOError(std::generic_category().message(error_number));
}

arrow::Status DescriptorStream::Write(void const* data, int64_t size) {
    auto const* bytes = static_cast<char const*>(data);
    if (gathered_.size() + static_cast<std::size_t>(size) <= kMostGathered) {
        gathered_.append(bytes, static_cast<std::size_t>(size));
        return arrow::Status::OK();
    }
    ARROW_RETURN_NOT_OK(Flush());
    return write_out(bytes, size);
}

arrow::Status DescriptorStream::Flush() {
    auto const status = write_out(gathered_.data(), static_cast<int64_t>(gathered_.size()));
    gathered_.clear();
    return status;
}

arrow::Status DescriptorStream::write_out(char const* bytes, int64_t size) {
    while (size > 0) {
        ssize_t const written = pwrite(descriptor_, bytes, static_cast<std::size_t>(size), position_);
        if (written < 0 && errno == EINTR) {
            continue;
        }
        if (written <= 0) {
            return system_error(written < 0 ? errno : EIO);
        }
        ++save_progress().writes;
        bytes += written;
        size -= written;
        position_ += written;
    }
    return arrow::Status::OK();
}

arrow::Status DescriptorStream::Close() {
    closed_ = true;
    return Flush();
}

void DescriptorStream::go_back_to(int64_t position) {
    gathered_.clear();
    position_ = position;
    [[maybe_unused]] auto const failed = ftruncate(descriptor_, position);  // readers stop at the truncated end anyway
}

}  // namespace pogosim
