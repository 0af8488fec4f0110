// The types of users' columns: how each is called, checked and stored. Only the builders of Arrow's arrays are
// elsewhere, in src/record/columns.cpp.
#pragma once

#include <cstddef>
#include <string_view>

#include "world/data_table.hpp"

namespace pogosim {

/// A row of the table of types.
struct ColumnTypeRow {
    ColumnType type;
    std::string_view name;      // in the functions data_add_column_*
    char const* name_in_array;  // as NumPy's array interface spells it
    std::size_t bytes;          // of a value in an array; 0 for text

    /// Writes a cell into an array of this type; one without a value as NaN, 0 or false. Null for text.
    void (*write)(std::byte* place, CellValue const& cell);

    /// A number as a cell. Throws ConfigError for one that this type does not have.
    CellValue (*cell_of)(ColumnSpec const& column, double value);
};

ColumnTypeRow const& row_of(ColumnType type);

}  // namespace pogosim
