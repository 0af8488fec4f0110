// The types an entry of `objects` can have. Each is a file in types/, with the function read_<name>() that fills an
// object from its keys, and a line of the table here; docs/new_object_type.md adds one.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "config/map_reader.hpp"
#include "config/scenario.hpp"

#define POGOSIM_OBJECT_TYPES(TYPE)                                                             \
    TYPE(pogobot, "Robot with two motors and four infrared emitters.")                         \
    TYPE(pogobject, "Head of a robot on a large body without motors.")                         \
    TYPE(pogowall, "Wall that runs user code and sends along its whole length.")               \
    TYPE(membrane, "Soft ring of disks that runs user code and sends along its whole length.") \
    TYPE(rectmembrane, "Like membrane, but made of rectangular segments.")                     \
    TYPE(active_object, "Pushable body with a program and infrared.")                          \
    TYPE(passive_object, "Pushable body.")                                                     \
    TYPE(static_light, "Stationary lamp.")                                                     \
    TYPE(orbiting_static_light, "Lamp that moves along a circle.")                             \
    TYPE(rotating_ray_of_light, "Lighthouse with one beam.")                                   \
    TYPE(alternating_rays_of_light, "Two lighthouses in two corners, active in turn.")

namespace pogosim {

struct ObjectType {
    std::string_view name;
    std::string_view doc;
    void (*read)(MapReader& reader, ObjectConfig& object);  // fills spec and position from its keys
};

std::span<ObjectType const> object_types();

#define POGOSIM_DECLARE_TYPE(name, doc) void read_##name(MapReader& reader, ObjectConfig& object);
POGOSIM_OBJECT_TYPES(POGOSIM_DECLARE_TYPE)
#undef POGOSIM_DECLARE_TYPE

/// One entry of `objects`, read and checked. Throws ConfigError.
ObjectConfig read_object(Place const& place, std::string const& category, bool strict);

// Keys of every type, `type` and `nb`.
std::span<Key<ObjectConfig> const> object_keys();

}  // namespace pogosim
