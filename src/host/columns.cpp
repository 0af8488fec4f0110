// The columns of the data file as arrays, where they are.
#include <algorithm>
#include <cstring>
#include <string>

#include "host/hosted_run.hpp"
#include "sim/saved_columns.hpp"

namespace pogosim {

namespace {

constexpr std::string_view kValues = "columns.";
constexpr std::string_view kAbsent = "columns_absent.";

/// As of NumPy's array interface.
char const* type_name(ColumnType type) {
    switch (type) {
        case ColumnType::int8:
            return "|i1";
        case ColumnType::int16:
            return "<i2";
        case ColumnType::int32:
            return "<i4";
        case ColumnType::int64:
            return "<i8";
        case ColumnType::float16:
            return "<f2";
        case ColumnType::float32:
            return "<f4";
        case ColumnType::float64:
            return "<f8";
        case ColumnType::boolean:
            return "|b1";
        case ColumnType::text:
            break;
    }
    return "text";
}

pogosim_array array_of(void const* data, char const* type, std::size_t size, std::size_t bytes_each) {
    pogosim_array array = {};
    array.data = data;
    std::strncpy(array.type, type, sizeof(array.type) - 1);
    array.dimensions = 1;
    array.shape[0] = static_cast<std::int64_t>(size);
    array.stride_bytes[0] = static_cast<std::int64_t>(bytes_each);
    return array;
}

pogosim_array values_of(SavedColumn const& column) {
    if (column.type == ColumnType::text) {
        static thread_local std::string texts;  // those of the run are replaced at the next save
        texts = column.texts;
        return array_of(texts.data(), type_name(column.type), texts.size(), 1);
    }
    return array_of(column.values.data(), type_name(column.type), column.is_absent.size(), bytes_of(column.type));
}

pogosim_array absent_in(SavedColumn const& column) {
    return array_of(column.is_absent.data(), type_name(ColumnType::boolean), column.is_absent.size(), 1);
}

}  // namespace

std::optional<pogosim_array> column_array_of(SavedColumns const& saved, std::string_view name) {
    bool const is_values = name.starts_with(kValues);
    if (!is_values && !name.starts_with(kAbsent)) {
        return std::nullopt;
    }
    name.remove_prefix(is_values ? kValues.size() : kAbsent.size());
    auto const found = std::ranges::find(saved.columns(), name, &SavedColumn::name);
    if (found == saved.columns().end()) {
        return std::nullopt;
    }
    return is_values ? values_of(*found) : absent_in(*found);
}

}  // namespace pogosim
