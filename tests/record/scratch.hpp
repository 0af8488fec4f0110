// A folder for the files of one test, and reading a data file back with Arrow itself.
#pragma once

#include <arrow/api.h>
#include <arrow/io/file.h>
#include <arrow/ipc/reader.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"

namespace pogosim {

/// Tests that write files: `path("a")` lies in a folder of this test's own, which is removed afterwards.
class FileTest : public testing::Test {
protected:
    std::string path(std::string const& name) const { return folder_ / name; }
    std::vector<std::string> files_in_folder() const { return folder_.names(); }

private:
    TemporaryFolder folder_;
};

/// An environment variable of this process, for as long as this object is there.
class EnvironmentVariable {
public:
    EnvironmentVariable(char const* name, std::string const& value) : name_(name) {
        if (char const* const before = std::getenv(name)) {
            before_ = before;
        }
        setenv(name, value.c_str(), 1);
    }
    ~EnvironmentVariable() {
        if (before_) {
            setenv(name_, before_->c_str(), 1);
        } else {
            unsetenv(name_);
        }
    }
    EnvironmentVariable(EnvironmentVariable const&) = delete;
    EnvironmentVariable& operator=(EnvironmentVariable const&) = delete;

private:
    char const* name_;
    std::optional<std::string> before_;
};

/// What a data file holds.
struct ReadBack {
    std::shared_ptr<arrow::Table> table;
    std::vector<std::int64_t> rows_of_batch;

    std::vector<std::string> column_names() const { return table->ColumnNames(); }

    std::shared_ptr<arrow::Scalar> cell(std::string const& column, std::int64_t row) const {
        return table->GetColumnByName(column)->GetScalar(row).ValueOrDie();
    }

    /// Cell as Arrow prints it; "null" for null.
    std::string text(std::string const& column, std::int64_t row) const { return cell(column, row)->ToString(); }
};

inline ReadBack read_back(std::string const& path) {
    auto const file = arrow::io::ReadableFile::Open(path).ValueOrDie();
    auto const reader = arrow::ipc::RecordBatchFileReader::Open(file).ValueOrDie();
    ReadBack result;
    arrow::RecordBatchVector batches;
    for (int i = 0; i < reader->num_record_batches(); ++i) {
        batches.push_back(reader->ReadRecordBatch(i).ValueOrDie());
        result.rows_of_batch.push_back(batches.back()->num_rows());
    }
    result.table = arrow::Table::FromRecordBatches(reader->schema(), batches).ValueOrDie();
    if (auto const status = result.table->ValidateFull(); !status.ok()) {
        throw std::runtime_error(path + ": " + status.ToString());
    }
    return result;
}

/// Rows of a file that was not closed: the stream behind the magic bytes, up to its torn end.
inline std::shared_ptr<arrow::Table> read_unfinished(std::string const& path) {
    auto const file = arrow::io::ReadableFile::Open(path).ValueOrDie();
    if (!file->Seek(8).ok()) {
        throw std::runtime_error(path + " has no head");
    }
    auto const reader = arrow::ipc::RecordBatchStreamReader::Open(file).ValueOrDie();
    arrow::RecordBatchVector batches;
    for (auto next = reader->Next(); next.ok() && *next != nullptr; next = reader->Next()) {
        batches.push_back(*next);
    }
    return arrow::Table::FromRecordBatches(reader->schema(), batches).ValueOrDie();
}

inline std::string bytes_of(std::string const& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace pogosim
