// A table that a run writes, row by row, in the format that its name says (base/table_format.hpp).
//
//     rows ──► cells ──► batches that are not yet ... ──► saved      unfinished_file.hpp, every few seconds
//                                                     └─► complete   complete_file.hpp, flush_row_count rows each
//
// Until the end, the path refers to the unfinished file, an Arrow file, which can be read whenever the run is killed.
// The contents of the complete one depend on the rows alone, not on the clock.
#pragma once

#include <arrow/memory_pool.h>
#include <arrow/result.h>
#include <arrow/status.h>
#include <arrow/type.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/locked_file.hpp"

namespace pogosim {

/// The words for a table in messages.
struct TableKind {
    char const* name;               // "data file"
    char const* key;                // of the configuration, that names its file
    char const* how_to_do_without;  // of the configuration
};

struct TableFileOptions {
    TableKind kind;
    std::string path;  // as the user wrote it
    std::int64_t flush_row_count;
    std::vector<std::pair<std::string, std::string>> metadata;  // of the schema, UTF-8
    arrow::MemoryPool* memory;                                  // for its rows; outlives the table
};

/// Every failure to write throws OutputError naming the path and the system's reason; nothing is lost silently. In a
/// child after fork(), it writes nothing.
class TableFile {
public:
    /// The cells added since the last call, one array per column.
    using TakeCells = std::function<arrow::Result<arrow::ArrayVector>()>;

    /// Opens and locks the file and creates its folder. The contents remain until a TableFile is created. Throws
    /// OutputError.
    static LockedFile reserve(TableKind const& kind, std::string const& path);

    /// Empties the file and writes its head.
    TableFile(TableFileOptions const& options, LockedFile file, arrow::FieldVector const& fields, TakeCells take);

    /// Closes the file if it is still open, writing as much as possible; errors are logged.
    ~TableFile();

    TableFile(TableFile const&) = delete;
    TableFile& operator=(TableFile const&) = delete;

    /// Rows that may be added before they are counted, > 0.
    std::size_t room() const;

    /// To be called for rows of one time, in the order of time, with what came of adding their cells. `count`: up to
    /// room().
    void count_rows(double time_s, std::size_t count, arrow::Status const& added);

    // As those of DataFile.
    void save_if_due();
    void save();
    void add_metadata(std::string const& key, std::string const& value);
    void close();
    std::int64_t row_count() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The action's status. Arrow reports most allocations that fail, but throws where the small ones do.
template <typename Action>
arrow::Status status_of(Action const& action) {
    try {
        return action();
    } catch (std::bad_alloc const&) {
        return arrow::Status::OutOfMemory("no memory");
    }
}

}  // namespace pogosim
