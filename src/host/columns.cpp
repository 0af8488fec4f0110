// The columns of the data file as arrays, where they are.
#include <algorithm>
#include <string>

#include "host/array_places.hpp"
#include "host/hosted_run.hpp"
#include "sim/saved_columns.hpp"
#include "world/data_table.hpp"

namespace pogosim {

namespace {

constexpr std::string_view kValues = "columns.";
constexpr std::string_view kAbsent = "columns_absent.";

pogosim_array array_of(void const* data, ColumnType type, std::size_t size) {
    ColumnTypeRow const& row = row_of(type);
    std::size_t const bytes_each = std::max<std::size_t>(row.bytes, 1);
    return described(data, row.name_in_array, {static_cast<std::int64_t>(size)},
                     {static_cast<std::int64_t>(bytes_each)});
}

pogosim_array values_of(SavedColumn const& column) {
    if (column.type == ColumnType::text) {
        static thread_local std::string texts;  // those of the run are replaced at the next save
        texts = column.texts;
        return array_of(texts.data(), column.type, texts.size());
    }
    return array_of(column.values.data(), column.type, column.is_absent.size());
}

pogosim_array absent_in(SavedColumn const& column) {
    return array_of(column.is_absent.data(), ColumnType::boolean, column.is_absent.size());
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
