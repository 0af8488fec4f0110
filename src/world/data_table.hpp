// User columns of the data file: what data_add_column_* declares and data_set_value_* fills. Kept apart from the file
// format, so that the room that calls user code and the room that writes files share nothing but this.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace pogosim {

enum class ColumnType { int8, int16, int32, int64, float64, text, boolean, float16, float32 };

struct ColumnSpec {
    std::string name;
    ColumnType type = ColumnType::float64;
};

/// One value; monostate is null. Integers of all widths travel as int64, float16 and float32 as double.
using CellValue = std::variant<std::monostate, std::int64_t, double, bool, std::string>;

/// User part of the rows of one save, which user code fills before anything is written.
struct DataTable {
    std::vector<std::uint32_t> object;  // by row: index into World::objects
    std::vector<CellValue> cells;       // of a row in the order of the columns, row after row

    std::span<CellValue const> cells_of(std::size_t row) const { return cells_of(row, row + 1); }

    /// Of the rows from `first` to `last` - 1.
    std::span<CellValue const> cells_of(std::size_t first, std::size_t last) const {
        std::size_t const columns = object.empty() ? 0 : cells.size() / object.size();
        return std::span(cells).subspan(first * columns, (last - first) * columns);
    }

    void clear() {
        object.clear();
        cells.clear();
    }
};

/// User part of the row that is being filled, in the order of the columns.
struct DataRow {
    std::span<CellValue> values{};
    bool exported = true;  // false: the user program disabled the export of this row
};

}  // namespace pogosim
