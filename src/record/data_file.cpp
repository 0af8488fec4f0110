#include "record/data_file.hpp"

#include <arrow/api.h>
#include <arrow/io/file.h>
#include <arrow/ipc/writer.h>
#include <arrow/util/compression.h>
#include <arrow/util/key_value_metadata.h>

#include <cassert>
#include <filesystem>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/utf8.hpp"
#include "record/columns.hpp"

namespace pogosim {

using arrow::Status;

namespace {

/// Throws OutputError with the path and the system's reason.
[[noreturn]] void fail(std::string const& path, std::string const& reason) {
    throw OutputError("cannot write the data file '" + path + "' (data_filename): " + reason);
}

constexpr auto kNotAFile =
    "it is a device, a pipe or a socket, not a file; for a run without data: enable_data_logging: false";

bool has_type(std::string const& path, std::filesystem::file_type type) {
    std::error_code error;
    return std::filesystem::status(path, error).type() == type;
}

void check(Status const& status, std::string const& path) {
    if (status.ok()) {
        return;
    }
    if (status.detail()) {  // what the system says
        fail(path, status.detail()->ToString());
    }
    // A device such as /dev/null knows no position in itself, which Arrow's own checks stumble over.
    fail(path, has_type(path, std::filesystem::file_type::character) ? kNotAFile : status.message());
}

template <class Value>
Value checked(arrow::Result<Value> result, std::string const& path) {
    check(result.status(), path);
    return std::move(result).ValueUnsafe();
}

void make_parent_folder(std::string const& path) {
    auto const parent = std::filesystem::path(path).parent_path();
    std::error_code error;
    if (!parent.empty() && !std::filesystem::create_directories(parent, error) && error) {
        fail(path, "cannot make the folder '" + parent.string() + "': " + error.message());
    }
}

/// Throws OutputError for what would take data for ever or destroy a disk. Opening a pipe would wait for its reader.
void check_kind_of_file(std::string const& path) {
    using std::filesystem::file_type;
    if (has_type(path, file_type::fifo) || has_type(path, file_type::socket) || has_type(path, file_type::block)) {
        fail(path, kNotAFile);
    }
}

/// Throws OutputError unless the file at `path` has the size that was written.
void check_size(std::string const& path, std::int64_t written_bytes) {
    std::error_code error;
    auto const size = std::filesystem::file_size(path, error);
    if (error) {
        fail(path, error.message() + " (after writing; did another program remove it?)");
    }
    if (size != static_cast<std::uintmax_t>(written_bytes)) {
        fail(path, std::to_string(written_bytes) + " bytes were written, but the file has " + std::to_string(size) +
                       "; did another program change it?");
    }
}

std::shared_ptr<arrow::KeyValueMetadata> make_metadata(DataFileOptions const& options) {
    auto metadata = std::make_shared<arrow::KeyValueMetadata>();
    for (auto const& [key, value] : options.metadata) {
        metadata->Append(key, replace_malformed(value));
    }
    return metadata;
}

arrow::ipc::IpcWriteOptions write_options(std::string const& path) {
    auto options = arrow::ipc::IpcWriteOptions::Defaults();
    options.codec = checked(arrow::util::Codec::Create(arrow::Compression::ZSTD), path);
    options.use_threads = false;  // the process stays single-threaded
    return options;
}

}  // namespace

struct DataFile::Impl {
    std::string path;
    std::int64_t flush_row_count;
    Columns columns;
    std::shared_ptr<arrow::Schema> schema;
    std::shared_ptr<arrow::io::FileOutputStream> stream;
    std::shared_ptr<arrow::ipc::RecordBatchWriter> writer;
    std::int64_t row_count = 0;
    std::int64_t buffered_rows = 0;
    bool open = false;  // false from the first failure on, too: nothing good can follow it

    explicit Impl(DataFileOptions const& options)
        : path(options.path), flush_row_count(options.flush_row_count), columns(options) {
        assert(flush_row_count > 0);
        make_parent_folder(path);
        check_kind_of_file(path);
        schema = arrow::schema(columns.fields(), make_metadata(options));
        stream = checked(arrow::io::FileOutputStream::Open(path), path);
        writer = checked(arrow::ipc::MakeFileWriter(stream, schema, write_options(path)), path);
        open = true;
    }

    Status write_batch() {
        ARROW_ASSIGN_OR_RAISE(auto arrays, columns.take());
        auto const batch = arrow::RecordBatch::Make(schema, buffered_rows, std::move(arrays));
        buffered_rows = 0;
        return writer->WriteRecordBatch(*batch);
    }

    /// After a failure the file is left as it is, and nothing more is tried.
    void check_still_open(Status const& status) {
        open = open && status.ok();
        check(status, path);
    }
};

DataFile::DataFile(DataFileOptions const& options) : impl_(std::make_unique<Impl>(options)) {}

DataFile::~DataFile() {
    try {
        close();
    } catch (std::exception const& error) {
        log().error("{}", error.what());
    }
}

void DataFile::append(ObjectRow const& row, std::vector<CellValue> const& user) {
    assert(impl_->open);
    impl_->check_still_open(impl_->columns.append(row, user));
    ++impl_->row_count;
    ++impl_->buffered_rows;
    if (impl_->buffered_rows == impl_->flush_row_count) {
        impl_->check_still_open(impl_->write_batch());
    }
}

void DataFile::close() {
    if (!impl_->open) {
        return;
    }
    if (impl_->buffered_rows > 0) {
        impl_->check_still_open(impl_->write_batch());
    }
    impl_->check_still_open(impl_->writer->Close());
    impl_->open = false;
    auto const written_bytes = checked(impl_->stream->Tell(), impl_->path);
    check(impl_->stream->Close(), impl_->path);
    check_size(impl_->path, written_bytes);
}

std::int64_t DataFile::row_count() const {
    return impl_->row_count;
}

}  // namespace pogosim
