// Keys that are unknown where they stand: those of objects at the top level, and the other way round; and keys of
// versions before 0.10, which the simulator no longer reads.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/tree.hpp"

namespace pogosim {

class ObjectTypes;

/// "; it belongs at the top level" or "; it belongs in a category, as objects.robots.battery", for a key that is
/// unknown in the map at `path`; empty if no other level has it. At the top level, `map` is the whole configuration.
/// `types`: those that objects may have; null: none.
std::string other_level(std::string_view path, std::string_view key, Node const& map, ObjectTypes const* types);

/// "; did you mean 'magnetometer.csv.file'?", for a key that is unknown in the map at `path`, and stands in one other
/// place only of a map such as `magnetometer` or `battery`; empty otherwise. At the top level and in a category, for
/// keys that belong one level further in. `names`: those that the map at `path` may have.
std::string inner_level(std::string_view path, std::string_view key, std::span<std::string const> names);

/// "; it is now 'simulation_time'" for the path of an old key; empty for any other.
std::string new_place(std::string_view path);

/// The old keys at the top level.
std::vector<std::string> old_keys(Node const& root);

}  // namespace pogosim
