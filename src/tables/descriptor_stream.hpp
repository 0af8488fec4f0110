// An Arrow stream for a file that is already open.
#pragma once

#include <arrow/io/interfaces.h>
#include <arrow/result.h>
#include <arrow/status.h>

#include <string>

namespace pogosim {

/// Writes to an open file from its beginning. Small pieces are buffered until Flush(), so that related data reach the
/// file together. Does not close the file.
class DescriptorStream final : public arrow::io::OutputStream {
public:
    explicit DescriptorStream(int descriptor) : descriptor_(descriptor) {}

    using arrow::io::OutputStream::Write;
    arrow::Status Write(void const* data, int64_t size) override;
    arrow::Status Flush() override;
    arrow::Result<int64_t> Tell() const override { return position_ + static_cast<int64_t>(gathered_.size()); }
    arrow::Status Close() override;
    bool closed() const override { return closed_; }

    /// Truncates the file at this position and continues there.
    void go_back_to(int64_t position);

private:
    arrow::Status write_out(char const* bytes, int64_t size);

    int descriptor_;
    int64_t position_ = 0;  // of what is gathered
    std::string gathered_;
    bool closed_ = false;
};

/// IOError with the system's text for `error_number` (errno).
arrow::Status system_error(int error_number);

}  // namespace pogosim
