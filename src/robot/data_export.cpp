#include "robot/data_export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "base/error.hpp"

namespace pogosim {

namespace {

bool holds(CellValue const& value) {
    return !std::holds_alternative<std::monostate>(value);
}

template <class T>
CellValue whole(ColumnSpec const& column, double value, char const* type) {
    constexpr double low = std::numeric_limits<T>::min();
    constexpr double high = -low;  // one more than the largest, which a double of 64 bits cannot be
    if (std::trunc(value) != value || value < low || value >= high) {
        throw ConfigError(
            fmt::format("the column '{}' was declared as {}, which {} is not: expected a whole number from {:.0f} to "
                        "{}",
                        column.name, type, value, low, std::numeric_limits<T>::max()));
    }
    return static_cast<std::int64_t>(value);
}

/// A number as a value of a column. Throws ConfigError for one that the column's type does not have.
CellValue cell_of(ColumnSpec const& column, double value) {
    switch (column.type) {
        case ColumnType::int8:
            return whole<std::int8_t>(column, value, "int8");
        case ColumnType::int16:
            return whole<std::int16_t>(column, value, "int16");
        case ColumnType::int32:
            return whole<std::int32_t>(column, value, "int32");
        case ColumnType::int64:
            return whole<std::int64_t>(column, value, "int64");
        case ColumnType::boolean:
            if (value != 0.0 && value != 1.0) {
                throw ConfigError(
                    fmt::format("the column '{}' was declared as bool: expected 0 or 1, found {}", column.name, value));
            }
            return value != 0.0;
        case ColumnType::text:
            throw ConfigError(
                fmt::format("the column '{}' was declared as string: only columns of numbers can be set", column.name));
        case ColumnType::float16:
        case ColumnType::float32:
        case ColumnType::float64:
            break;
    }
    return value;
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
    CellValue const cell = cell_of(*found, value);
    if (object) {
        held.set_for(column, *object, object_count, cell);
    } else {
        held.set_for_all(column, cell);
    }
    was_set[column] = true;
}

}  // namespace pogosim
