// User columns of the data file: what data_add_column_* declares and data_set_value_* fills. Kept apart from the file
// format, so that the room that calls user code and the room that writes files share nothing but this.
#pragma once

#include <cstdint>
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

/// User part of one row, in the order of the columns.
struct DataRow {
    std::vector<CellValue> values;
    bool exported = true;  // false: the user program disabled the export of this row
};

}  // namespace pogosim
