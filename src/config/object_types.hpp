// The types an entry of `objects` can have. Each is a function that fills an object from its keys, and a line in the
// table of solid_types.cpp or lamps/lamp_types.cpp; docs/new_object_type.md adds one.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "config/map_reader.hpp"
#include "config/scenario.hpp"

namespace pogosim {

struct ObjectType {
    std::string_view name;
    std::string_view doc;
    void (*read)(MapReader& reader, ObjectConfig& object);  // fills spec and position from its keys
};

std::span<ObjectType const> solid_types();
/// Defined in lamps/lamp_types.cpp: lamps read their keys beside their light, in a room that this one does not know.
std::span<ObjectType const> lamp_types();
/// All types.
std::span<ObjectType const> object_types();

/// One entry of `objects`, read and checked, into a new `object`. Returns the values of the keys that mean something.
/// Throws ConfigError if it is no map, or of an unknown type; other mistakes are collected in `reading`.
Node read_object(Place const& place, std::string const& category, Reading& reading, ObjectConfig& object);

// Keys of every type, `type` and `nb`.
std::span<Key<ObjectConfig> const> object_keys();

}  // namespace pogosim
