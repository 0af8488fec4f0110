// User columns of the data file: what data_add_column_* declares and data_set_value_* fills. Kept apart from the file
// format, so that this is all that the room that calls user code and the room that writes files have in common.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
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

/// User columns of the rows of one save. User code fills them before anything is written.
struct DataTable {
    std::vector<std::uint32_t> object;  // by row: index into World::objects
    std::vector<CellValue> cells;       // of a row in the order of the columns, row after row

    std::span<CellValue const> cells_of(std::size_t row) const { return cells_of(row, row + 1); }

    /// The part with the rows from `first` to `last` - 1.
    std::span<CellValue const> cells_of(std::size_t first, std::size_t last) const {
        std::size_t const columns = object.empty() ? 0 : cells.size() / object.size();
        return std::span(cells).subspan(first * columns, (last - first) * columns);
    }

    void clear() {
        object.clear();
        cells.clear();
    }
};

/// User columns of the row that is being filled, in their order.
struct DataRow {
    std::span<CellValue> values{};
    bool exported = true;  // false: the user program disabled the export of this row
};

// The types of users' columns: how each is called, checked and stored. Only the builders of Arrow's arrays are
// elsewhere, in src/tables/columns.cpp.

/// A row of the table of types.
struct ColumnTypeRow {
    ColumnType type;
    std::string_view name;      // in the functions data_add_column_*
    char const* name_in_array;  // as NumPy's array interface spells it
    std::size_t bytes;          // of a value in an array; 0 for text

    /// Writes a cell into an array of this type; one without a value as NaN, 0 or false. Null for text.
    void (*write)(std::byte* place, CellValue const& cell);

    /// The number at a place in such an array. Null for text.
    double (*read)(std::byte const* place);

    /// A number as a cell. Throws ConfigError for one that this type does not have.
    CellValue (*cell_of)(ColumnSpec const& column, double value);
};

ColumnTypeRow const& row_of(ColumnType type);

}  // namespace pogosim
