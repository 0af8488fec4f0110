#include "robot/hold_value.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"

namespace pogosim {

void hold_value(DataExport& data, std::size_t object_count, std::optional<std::uint32_t> object, std::string_view name,
                double value) {
    auto const found = std::ranges::find(data.columns, name, &ColumnSpec::name);
    if (found == data.columns.end()) {
        throw ConfigError(
            fmt::format("the data file has no column '{}' of the program; declare it with data_add_column_* in "
                        "callback_create_data_schema",
                        name));
    }
    auto const column = static_cast<std::size_t>(found - data.columns.begin());
    CellValue const cell = cell_of(*found, value);
    if (object) {
        data.held.set_for(column, *object, object_count, cell);
    } else {
        data.held.set_for_all(column, cell);
    }
    data.was_set[column] = true;
}

}  // namespace pogosim
