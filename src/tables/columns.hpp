// The columns of the data file, and their cells that are not yet written. Tables in columns.cpp list all columns; those
// of a file are chosen once, so that the rows of a moment cost one indirect call per column.
#pragma once

#include <arrow/builder.h>
#include <arrow/memory_pool.h>
#include <arrow/result.h>
#include <arrow/type.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "record/data_file.hpp"
#include "world/data_table.hpp"

namespace pogosim {

struct BuiltInColumn;   // filled from the built-in part of rows
struct UserColumnType;  // how cells of a user column are stored

class Columns {
public:
    /// Columns in the order of the file. Warns about unknown columns in `options.fields`. Throws ConfigError if a name
    /// is empty or repeated, or if `options.fields` leaves no column. `memory` outlives this and the cells.
    Columns(DataFileOptions const& options, arrow::MemoryPool* memory);

    arrow::FieldVector const& fields() const { return fields_; }

    /// Adds a cell of each row to each column; as DataFile::append.
    arrow::Status append(std::span<ObjectRow const> rows, std::span<CellValue const> user);

    /// The cells added since the last call, one array per column.
    arrow::Result<arrow::ArrayVector> take();

private:
    struct BuiltIn {
        BuiltInColumn const* column;
        std::unique_ptr<arrow::ArrayBuilder> cells;
    };
    struct User {
        UserColumnType const* type;
        std::size_t index;  // into the user part of a row
        std::unique_ptr<arrow::ArrayBuilder> cells;
    };

    arrow::Status reserve(std::int64_t row_count);

    arrow::FieldVector fields_;
    std::vector<BuiltIn> built_ins_;
    std::vector<User> users_;
    std::size_t user_column_count_;
    std::int64_t taken_rows_ = 0;  // at the last time: about as many will come
};

}  // namespace pogosim
