// simulation.h: columns and values of the data file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "base/error.hpp"
#include "process/crash_handler.hpp"
#include "robot/call_checks.hpp"
#include "robot/context.hpp"
#include "world/data_table.hpp"

using pogosim::CellValue;
using pogosim::ColumnType;
using pogosim::ConfigError;
using pogosim::context;
using pogosim::DataExport;
using pogosim::require_argument;
using pogosim::require_robot;
using pogosim::without_exceptions;

namespace {

void check_call(char const* function, char const* name) {
    require_robot(function);
    require_argument(name, function, "the name of the column");
}

void add_column(char const* function, char const* name, ColumnType type) {
    check_call(function, name);
    without_exceptions([&] {
        DataExport& data = context.services->data;
        if (!data.declaring) {
            throw ConfigError(
                fmt::format("{}(\"{}\"): columns can only be added in callback_create_data_schema", function, name));
        }
        bool const known =
            std::any_of(data.columns.begin(), data.columns.end(), [&](auto const& c) { return c.name == name; });
        if (known) {
            throw ConfigError(
                fmt::format("{}(\"{}\"): the data file already has a column of this name", function, name));
        }
        data.columns.push_back({.name = name, .type = type});
        data.was_set.push_back(false);
    });
}

/// Columns are few, and programs usually set them in the order of their declaration: the search starts behind the
/// column found last.
std::size_t find_column(DataExport& data, char const* name) {
    std::size_t const count = data.columns.size();
    for (std::size_t tried = 0; tried < count; ++tried) {
        std::size_t const i = (data.next_column + tried) % count;
        if (data.columns[i].name == name) {
            data.next_column = i + 1;
            return i;
        }
    }
    throw ConfigError(
        fmt::format("data_set_value: the data file has no column '{}'; declare it with data_add_column_* in "
                    "callback_create_data_schema",
                    name));
}

void note_outside_of_export(char const* function) {
    context.services->warn_once_of({.text = "outside of callback_export_data", .function = function},
                                   "{}() has no effect outside of callback_export_data", function);
}

/// Whether the value is for the column behind the last one, as it usually is.
bool is_for_next_column(DataExport const& data, char const* name, ColumnType type) {
    if (!data.filling || data.next_column >= data.columns.size()) {
        return false;
    }
    auto const& next = data.columns[data.next_column];
    return next.type == type && std::strcmp(next.name.c_str(), name) == 0;
}

/// `Value`: an alternative of CellValue.
template <class Value>
void set_value(char const* function, char const* name, ColumnType type, Value value) {
    check_call(function, name);
    if constexpr (std::is_arithmetic_v<Value>) {
        if (DataExport& data = context.services->data; is_for_next_column(data, name, type)) [[likely]] {
            data.row.values[data.next_column] = value;
            data.was_set[data.next_column] = true;
            ++data.next_column;
            return;
        }
    }
    without_exceptions([&] {
        DataExport& data = context.services->data;
        if (!data.filling) {
            note_outside_of_export(function);
            return;
        }
        std::size_t const column = find_column(data, name);
        if (data.columns[column].type != type) {
            throw ConfigError(fmt::format("{}(\"{}\"): the column was declared as {}", function, name,
                                          pogosim::row_of(data.columns[column].type).name));
        }
        data.row.values[column] = std::move(value);
        data.was_set[column] = true;
    });
}

/// `function`: the one that the value is for.
template <class Integer>
Integer as_column(char const* function, std::int64_t value) {
    auto const recorded = static_cast<Integer>(value);
    if (recorded != value) [[unlikely]] {
        constexpr std::string_view expected = sizeof(Integer) == 1   ? "-128 to 127"
                                              : sizeof(Integer) == 2 ? "-32768 to 32767"
                                                                     : "-2147483648 to 2147483647";
        pogosim::note_slip({function, "value", expected, "its lowest bits are recorded; take a larger type"}, value);
    }
    return recorded;
}

void set_exported(char const* function, bool exported) {
    require_robot(function);
    if (!context.services->data.filling) [[unlikely]] {
        note_outside_of_export(function);
        return;
    }
    context.services->data.row.exported = exported;
}

}  // namespace

void data_add_column_int8(char const* name) {
    add_column(__func__, name, ColumnType::int8);
}
void data_add_column_int16(char const* name) {
    add_column(__func__, name, ColumnType::int16);
}
void data_add_column_int32(char const* name) {
    add_column(__func__, name, ColumnType::int32);
}
void data_add_column_int64(char const* name) {
    add_column(__func__, name, ColumnType::int64);
}
void data_add_column_double(char const* name) {
    add_column(__func__, name, ColumnType::float64);
}
void data_add_column_string(char const* name) {
    add_column(__func__, name, ColumnType::text);
}
void data_add_column_bool(char const* name) {
    add_column(__func__, name, ColumnType::boolean);
}
void data_add_column_float16(char const* name) {
    add_column(__func__, name, ColumnType::float16);
}

void data_add_column_float(char const* name) {
    add_column(__func__, name, ColumnType::float32);
}

int8_t pogosim_int8_value(int64_t value) {
    return as_column<std::int8_t>("data_set_value_int8", value);
}
int16_t pogosim_int16_value(int64_t value) {
    return as_column<std::int16_t>("data_set_value_int16", value);
}
int32_t pogosim_int32_value(int64_t value) {
    return as_column<std::int32_t>("data_set_value_int32", value);
}
int32_t pogosim_int32_of_unsigned(unsigned int value) {
    return static_cast<int32_t>(value);
}
void data_set_value_int8(char const* name, int8_t value) {
    set_value(__func__, name, ColumnType::int8, std::int64_t{value});
}
void data_set_value_int16(char const* name, int16_t value) {
    set_value(__func__, name, ColumnType::int16, std::int64_t{value});
}
void data_set_value_int32(char const* name, int32_t value) {
    set_value(__func__, name, ColumnType::int32, std::int64_t{value});
}
void data_set_value_int64(char const* name, int64_t value) {
    set_value(__func__, name, ColumnType::int64, std::int64_t{value});
}
void data_set_value_double(char const* name, double value) {
    set_value(__func__, name, ColumnType::float64, value);
}
void data_set_value_string(char const* name, char const* value) {
    set_value(__func__, name, ColumnType::text, value != nullptr ? CellValue(std::string(value)) : CellValue());
}
void data_set_value_bool(char const* name, bool value) {
    set_value(__func__, name, ColumnType::boolean, value);
}
void data_set_value_float16(char const* name, float value) {
    constexpr float largest = 65520.0F;  // from here on, infinity is nearer than 65504
    if (std::isfinite(value) && std::abs(value) >= largest) [[unlikely]] {
        pogosim::note_slip({__func__, "value", "-65504 to 65504", "infinity is recorded"}, value);
    }
    set_value(__func__, name, ColumnType::float16, static_cast<double>(value));
}

void data_set_value_float(char const* name, float value) {
    set_value(__func__, name, ColumnType::float32, static_cast<double>(value));
}

void enable_data_export() {
    set_exported(__func__, true);
}
void disable_data_export() {
    set_exported(__func__, false);
}

uint32_t get_nb_robots() {
    require_robot(__func__);
    return static_cast<uint32_t>(context.world->robots.size());
}
void stop_simulation() {
    require_robot(__func__);
    bool& stop_requested =
        context.outbox != nullptr ? context.outbox->stop_requested : context.services->stop_requested;
    stop_requested = true;
}
