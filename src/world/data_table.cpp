#include "world/data_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include "base/error.hpp"
#include "base/half.hpp"

namespace pogosim {

namespace {

/// What a cell of a type with such numbers contains.
template <class Number>
using InCell = std::conditional_t<std::is_same_v<Number, bool>, bool,
                                  std::conditional_t<std::is_floating_point_v<Number>, double, std::int64_t>>;

template <class Number>
Number number_in(CellValue const& cell) {
    using Given = InCell<Number>;
    auto const* const given = std::get_if<Given>(&cell);
    constexpr Given none = std::is_floating_point_v<Number> ? std::numeric_limits<Given>::quiet_NaN() : Given{};
    return static_cast<Number>(given != nullptr ? *given : none);
}

template <class Number>
void write(std::byte* place, CellValue const& cell) {
    Number const number = number_in<Number>(cell);
    std::memcpy(place, &number, sizeof(number));
}

template <class Number>
double read(std::byte const* place) {
    Number number{};
    std::memcpy(&number, place, sizeof(number));
    return static_cast<double>(number);
}

double read_half(std::byte const* place) {
    std::uint16_t half = 0;
    std::memcpy(&half, place, sizeof(half));
    return from_half(half);
}

void write_half(std::byte* place, CellValue const& cell) {
    std::uint16_t const half = to_half(number_in<double>(cell));
    std::memcpy(place, &half, sizeof(half));
}

template <class Integer>
CellValue whole(ColumnSpec const& column, double value) {
    constexpr double low = std::numeric_limits<Integer>::min();
    if (std::isnan(value)) {
        return {};
    }
    constexpr double high = -low;  // one more than the largest, which a double of 64 bits cannot be
    if (std::trunc(value) != value || value < low || value >= high) {
        throw ConfigError(
            fmt::format("the column '{}' was declared as {}, which {} is not: expected a whole number from {:.0f} to "
                        "{}",
                        column.name, row_of(column.type).name, value, low, std::numeric_limits<Integer>::max()));
    }
    return static_cast<std::int64_t>(value);
}

/// Infinity is as good as any number, but not what another one should become. `largest`: of the type.
CellValue real_in_cell(ColumnSpec const& column, double value, bool becomes_infinite, double largest) {
    if (becomes_infinite && std::isfinite(value)) {
        throw ConfigError(fmt::format(
            "the column '{}' was declared as {}, which {} is not: expected a number from {:g} to {:g}, or infinity",
            column.name, row_of(column.type).name, value, -largest, largest));
    }
    return value;
}

CellValue real16(ColumnSpec const& column, double value) {
    constexpr unsigned infinity = 0x7C00;
    return real_in_cell(column, value, (to_half(value) & 0x7FFFU) == infinity, 65504.0);
}

CellValue real32(ColumnSpec const& column, double value) {
    return real_in_cell(column, value, std::isinf(static_cast<float>(value)), std::numeric_limits<float>::max());
}

CellValue real64(ColumnSpec const& /*column*/, double value) {
    return value;
}

CellValue truth(ColumnSpec const& column, double value) {
    if (std::isnan(value)) {
        return {};
    }
    if (value != 0.0 && value != 1.0) {
        throw ConfigError(
            fmt::format("the column '{}' was declared as bool: expected 0 or 1, found {}", column.name, value));
    }
    return value != 0.0;
}

CellValue refuse_text(ColumnSpec const& column, double /*value*/) {
    throw ConfigError(
        fmt::format("the column '{}' was declared as string: only columns of numbers can be set", column.name));
}

template <class Integer>
constexpr ColumnTypeRow row_of_whole(ColumnType type, std::string_view name, char const* name_in_array) {
    return {type, name, name_in_array, sizeof(Integer), write<Integer>, read<Integer>, whole<Integer>};
}

constexpr std::array kTypes{
    row_of_whole<std::int8_t>(ColumnType::int8, "int8", "|i1"),
    row_of_whole<std::int16_t>(ColumnType::int16, "int16", "<i2"),
    row_of_whole<std::int32_t>(ColumnType::int32, "int32", "<i4"),
    row_of_whole<std::int64_t>(ColumnType::int64, "int64", "<i8"),
    ColumnTypeRow{ColumnType::float16, "float16", "<f2", sizeof(std::uint16_t), write_half, read_half, real16},
    ColumnTypeRow{ColumnType::float32, "float", "<f4", sizeof(float), write<float>, read<float>, real32},
    ColumnTypeRow{ColumnType::float64, "double", "<f8", sizeof(double), write<double>, read<double>, real64},
    ColumnTypeRow{ColumnType::boolean, "bool", "|b1", sizeof(bool), write<bool>, read<bool>, truth},
    ColumnTypeRow{ColumnType::text, "string", "text", 0, nullptr, nullptr, refuse_text},
};

}  // namespace

ColumnTypeRow const& row_of(ColumnType type) {
    auto const* const found = std::ranges::find(kTypes, type, &ColumnTypeRow::type);
    assert(found != kTypes.end());
    return *found;
}

}  // namespace pogosim
