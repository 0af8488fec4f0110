// Values of user columns that callbacks of the whole run set, for all objects or for one: they stand in all rows from
// then on, unless an object's callback_export_data sets its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "world/data_table.hpp"

namespace pogosim {

class HeldValues {
public:
    /// No value has been set.
    bool empty() const { return columns_.empty(); }

    /// Also for objects that had a value of their own.
    void set_for_all(std::size_t column, CellValue const& value);

    /// `object`: index into World::objects, of so many.
    void set_for(std::size_t column, std::uint32_t object, std::size_t object_count, CellValue const& value);

    /// Puts the values of an object into its row. Cells without a value stay as they are.
    void fill(std::uint32_t object, std::span<CellValue> row) const;

private:
    /// A monostate: no value.
    struct Column {
        CellValue of_all;
        std::vector<CellValue> of_object;  // empty, or one for each object
    };

    Column& at(std::size_t column);

    std::vector<Column> columns_;
};

/// A number as a value of a column. Throws ConfigError for one that the column's type does not have.
CellValue cell_of(ColumnSpec const& column, double value);

}  // namespace pogosim
