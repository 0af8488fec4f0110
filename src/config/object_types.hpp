// The types an entry of `objects` can have. Each is a function that fills an object from its keys, and a line in the
// table of solid_types.cpp or lamps/lamp_types.cpp; docs/new_object_type.md adds one. Lamps read their keys beside
// their light, in a room that this one does not know, so the loader is given their table.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/map_reader.hpp"
#include "config/scenario.hpp"

namespace pogosim {

struct ObjectType {
    std::string_view name;
    std::string_view doc;
    void (*read)(MapReader& reader, ObjectConfig& object);  // fills spec and position from its keys
    DrawnAs drawn_as = DrawnAs::nothing;                    // a lamp
};

std::span<ObjectType const> solid_types();

/// All types that a configuration can name: those of solid_types(), and lamps.
class ObjectTypes {
public:
    explicit ObjectTypes(std::span<ObjectType const> lamps);
    ObjectTypes(ObjectTypes const&) = delete;  // keys refer to the text
    ObjectTypes& operator=(ObjectTypes const&) = delete;

    auto begin() const { return types_.begin(); }
    auto end() const { return types_.end(); }

    /// The type that the node at `place` names. Throws ConfigError if there is none.
    ObjectType const& at(Place const& place) const;

    /// Keys of every type: `type`, `robot_model` and `nb`.
    std::span<Key<ObjectConfig> const> common_keys() const { return common_keys_; }

private:
    std::vector<ObjectType> types_;
    std::vector<std::string> names_;
    std::string names_text_;
    std::vector<Key<ObjectConfig>> common_keys_;
};

/// One entry of `objects`, read and checked, into a new `object`. Returns the values of the keys that mean something.
/// Throws ConfigError if it is no map, or of a type that is not in `reading.types`; other mistakes are collected there.
Node read_object(Place const& place, std::string const& category, Reading& reading, ObjectConfig& object);

}  // namespace pogosim
