// The types an entry of `objects` can have. A new type is one file with a function that reads its keys and one line of
// the table in object_types.cpp.
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

std::span<ObjectType const> object_types();

/// One entry of `objects`, read and checked. Throws ConfigError.
ObjectConfig read_object(std::string const& category, Node const& node, bool strict);

// Keys of every type, `type` and `nb`.
std::span<Key<ObjectConfig> const> object_keys();

// The types, one file each.
void read_pogobot(MapReader& reader, ObjectConfig& object);
void read_pogobject(MapReader& reader, ObjectConfig& object);
void read_pogowall(MapReader& reader, ObjectConfig& object);
void read_membrane(MapReader& reader, ObjectConfig& object);
void read_rectmembrane(MapReader& reader, ObjectConfig& object);
void read_active_object(MapReader& reader, ObjectConfig& object);
void read_passive_object(MapReader& reader, ObjectConfig& object);
void read_static_light(MapReader& reader, ObjectConfig& object);
void read_orbiting_static_light(MapReader& reader, ObjectConfig& object);
void read_rotating_ray_of_light(MapReader& reader, ObjectConfig& object);
void read_alternating_rays_of_light(MapReader& reader, ObjectConfig& object);

}  // namespace pogosim
