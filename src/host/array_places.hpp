// Where arrays of the simulator are, as pogosim/host.h says it.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <string_view>
#include <type_traits>
#include <vector>

#include "pogosim/host.h"
#include "world/world.hpp"

namespace pogosim {

static_assert(std::endian::native == std::endian::little, "array types are named for little-endian machines");

/// The type of numbers, as NumPy writes it: "<f4".
template <class T>
std::string_view type_of() {
    constexpr char kKind = std::is_floating_point_v<T> ? 'f' : std::is_signed_v<T> ? 'i' : 'u';
    static constexpr std::array kType{sizeof(T) == 1 ? '|' : '<', kKind, static_cast<char>('0' + sizeof(T))};
    return {kType.data(), kType.size()};
}

inline pogosim_array described(void const* data, std::string_view type, std::initializer_list<std::int64_t> shape,
                               std::initializer_list<std::int64_t> strides) {
    pogosim_array array = {};
    array.data = const_cast<void*>(data);  // host.h says which arrays may be written
    type.copy(array.type, sizeof(array.type) - 1);
    array.dimensions = static_cast<int>(shape.size());
    std::ranges::copy(shape, std::begin(array.shape));
    std::ranges::copy(strides, std::begin(array.stride_bytes));
    return array;
}

template <class T>
pogosim_array numbers(std::vector<T> const& values) {
    return described(values.data(), type_of<T>(), {static_cast<std::int64_t>(values.size())}, {sizeof(T)});
}

inline pogosim_array leds(std::vector<Leds> const& values) {
    static_assert(sizeof(Rgb) == 3 && sizeof(Leds) == kLedCount * sizeof(Rgb));
    return described(values.data(), "|u1", {static_cast<std::int64_t>(values.size()), kLedCount, 3},
                     {sizeof(Leds), sizeof(Rgb), 1});
}

/// A table: so many numbers of one type in each row.
template <class Number, class Row>
pogosim_array table(std::vector<Row> const& rows) {
    static_assert(sizeof(Row) % sizeof(Number) == 0);
    return described(rows.data(), type_of<Number>(),
                     {static_cast<std::int64_t>(rows.size()), static_cast<std::int64_t>(sizeof(Row) / sizeof(Number))},
                     {sizeof(Row), sizeof(Number)});
}

}  // namespace pogosim
