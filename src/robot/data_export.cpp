#include "robot/data_export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "base/error.hpp"
#include "world/data_table.hpp"

namespace pogosim {

namespace {

bool holds(CellValue const& value) {
    return !std::holds_alternative<std::monostate>(value);
}

}  // namespace

HeldValues::Column& HeldValues::at(std::size_t column) {
    if (columns_.size() <= column) {
        columns_.resize(column + 1);
    }
    return columns_[column];
}

void HeldValues::set_for_all(std::size_t column, CellValue const& value) {
    Column& held = at(column);
    held.of_all = value;
    held.of_object.clear();
}

void HeldValues::set_for(std::size_t column, std::uint32_t object, std::size_t object_count, CellValue const& value) {
    Column& held = at(column);
    held.of_object.resize(object_count);
    held.of_object[object] = value;
}

void HeldValues::fill(std::uint32_t object, std::span<CellValue> row) const {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        Column const& held = columns_[i];
        if (!held.of_object.empty() && holds(held.of_object[object])) {
            row[i] = held.of_object[object];
        } else if (holds(held.of_all)) {
            row[i] = held.of_all;
        }
    }
}

void DataExport::hold(std::size_t object_count, std::optional<std::uint32_t> object, std::string_view name,
                      double value) {
    auto const found = std::ranges::find(columns, name, &ColumnSpec::name);
    if (found == columns.end()) {
        throw ConfigError(
            fmt::format("the data file has no column '{}' of the program; declare it with data_add_column_* in "
                        "callback_create_data_schema",
                        name));
    }
    auto const column = static_cast<std::size_t>(found - columns.begin());
    CellValue const cell = row_of(found->type).cell_of(*found, value);
    if (object) {
        held.set_for(column, *object, object_count, cell);
    } else {
        held.set_for_all(column, cell);
    }
    was_set[column] = true;
}

}  // namespace pogosim
