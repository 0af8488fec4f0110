#include "sim/saved_columns.hpp"

#include <algorithm>
#include <cstring>
#include <type_traits>
#include <variant>

#include "base/utf8.hpp"
#include "record/half.hpp"

namespace pogosim {

namespace {

constexpr std::size_t kNoRow = std::numeric_limits<std::size_t>::max();
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// The cell's number, or that of a cell without one.
template <class Number>
Number number_of(CellValue const& cell) {
    if constexpr (std::is_same_v<Number, bool>) {
        bool const* const given = std::get_if<bool>(&cell);
        return given != nullptr && *given;
    } else if constexpr (std::is_floating_point_v<Number>) {
        double const* const given = std::get_if<double>(&cell);
        return static_cast<Number>(given != nullptr ? *given : kNoNumber);
    } else {
        std::int64_t const* const given = std::get_if<std::int64_t>(&cell);
        return static_cast<Number>(given != nullptr ? *given : 0);
    }
}

template <class Number>
void write(std::byte* place, Number value) {
    std::memcpy(place, &value, sizeof(value));
}

void write_value(ColumnType type, std::byte* place, CellValue const& cell) {
    switch (type) {
        case ColumnType::int8:
            return write(place, number_of<std::int8_t>(cell));
        case ColumnType::int16:
            return write(place, number_of<std::int16_t>(cell));
        case ColumnType::int32:
            return write(place, number_of<std::int32_t>(cell));
        case ColumnType::int64:
            return write(place, number_of<std::int64_t>(cell));
        case ColumnType::float16:
            return write(place, to_half(number_of<double>(cell)));
        case ColumnType::float32:
            return write(place, number_of<float>(cell));
        case ColumnType::float64:
            return write(place, number_of<double>(cell));
        case ColumnType::boolean:
            return write(place, number_of<bool>(cell));
        case ColumnType::text:
            return;
    }
}

/// A text cannot contain a zero byte, since it comes from C (data_set_value_string).
void add_text(std::string& texts, CellValue const& cell) {
    if (auto const* const given = std::get_if<std::string>(&cell)) {
        texts += well_formed_prefix(*given) == given->size() ? *given : replace_malformed(*given);
    }
    texts += '\0';
}

}  // namespace

std::size_t bytes_of(ColumnType type) {
    switch (type) {
        case ColumnType::int8:
        case ColumnType::boolean:
            return 1;
        case ColumnType::int16:
        case ColumnType::float16:
            return 2;
        case ColumnType::int32:
        case ColumnType::float32:
            return 4;
        case ColumnType::int64:
        case ColumnType::float64:
            return 8;
        case ColumnType::text:
            break;
    }
    return 0;
}

void SavedColumns::open(std::span<ColumnSpec const> columns, std::size_t robot_count) {
    columns_.clear();
    for (ColumnSpec const& spec : columns) {
        SavedColumn& column = columns_.emplace_back();
        column.name = replace_malformed(spec.name);
        column.type = spec.type;
        column.values.resize(robot_count * bytes_of(spec.type));
        column.is_absent.resize(robot_count, 1);
    }
    row_of_robot_.resize(robot_count);
}

void SavedColumns::save(World const& world, DataTable const& rows) {
    time_s_ = world.time_s();
    std::ranges::fill(row_of_robot_, kNoRow);
    for (std::size_t row = 0; row < rows.object.size(); ++row) {
        Object const& object = world.objects[rows.object[row]];
        if (object.robot != kNone) {
            row_of_robot_[object.robot] = row;
        }
    }
    CellValue const none;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        SavedColumn& column = columns_[i];
        std::size_t const bytes = bytes_of(column.type);
        column.texts.clear();
        for (std::size_t robot = 0; robot < row_of_robot_.size(); ++robot) {
            std::size_t const row = row_of_robot_[robot];
            CellValue const& cell = row != kNoRow ? rows.cells_of(row)[i] : none;
            column.is_absent[robot] = std::holds_alternative<std::monostate>(cell) ? 1 : 0;
            if (column.type == ColumnType::text) {
                add_text(column.texts, cell);
            } else {
                write_value(column.type, column.values.data() + robot * bytes, cell);
            }
        }
    }
}

}  // namespace pogosim
