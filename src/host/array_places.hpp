// Where arrays of the simulator are, as pogosim/host.h says it.
#pragma once

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "pogosim/host.h"
#include "world/world.hpp"

namespace pogosim {

static_assert(std::endian::native == std::endian::little, "array types are named for little-endian machines");

template <class T>
std::string type_of() {
    char const kind = std::is_floating_point_v<T> ? 'f' : std::is_signed_v<T> ? 'i' : 'u';
    return fmt::format("{}{}{}", sizeof(T) == 1 ? '|' : '<', kind, sizeof(T));
}

inline pogosim_array described(void const* data, std::string const& type, std::vector<std::int64_t> const& shape,
                               std::vector<std::int64_t> const& strides) {
    pogosim_array array = {};
    array.data = const_cast<void*>(data);  // host.h says which arrays may be written
    std::strncpy(array.type, type.c_str(), sizeof(array.type) - 1);
    array.dimensions = static_cast<int>(shape.size());
    for (std::size_t i = 0; i < shape.size(); ++i) {
        array.shape[i] = shape[i];
        array.stride_bytes[i] = strides[i];
    }
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
