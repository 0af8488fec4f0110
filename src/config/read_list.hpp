// Lists of maps, such as the faces of a robot.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "config/map_reader.hpp"

namespace pogosim {

/// Reads the list under a key; `read` makes a part of each map. Nothing without the key.
template <class T, class Read>
void read_list(MapReader& reader, std::string_view key, std::string_view expected, std::size_t least, std::size_t most,
               std::vector<T>& parts, Read const& read) {
    Node const* const list = reader.find(key);
    if (list == nullptr) {
        return;
    }
    Place const place{*list, reader.path_of(key)};
    if (list->kind != Node::Kind::sequence) {
        fail_expected(place, expected);
    }
    if (list->items.size() < least || list->items.size() > most) {
        fail_at(place, fmt::format("expected {} to {} entries, found {}", least, most, list->items.size()));
    }
    std::vector<T> read_parts;
    Node values;
    values.kind = Node::Kind::sequence;
    for (std::size_t i = 0; i < list->items.size(); ++i) {
        MapReader inner(list->items[i], fmt::format("{}.{}", place.path, i), reader.reading());
        read_parts.push_back(read(inner));
        inner.finish();
        values.items.push_back(inner.values());
    }
    parts = std::move(read_parts);
    reader.set_value(key, std::move(values));
}

}  // namespace pogosim
