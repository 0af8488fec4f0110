// Keys that stand in the wrong map of a configuration: those of objects at the top level, and the other way round.
#pragma once

#include <string>
#include <string_view>

#include "config/tree.hpp"

namespace pogosim {

/// "; it belongs at the top level" or "; it belongs in a category, as objects.robots.battery", for a key that is
/// unknown in the map at `path`; empty if no other level has it. At the top level, `map` is the whole configuration.
std::string other_level(std::string_view path, std::string_view key, Node const& map);

}  // namespace pogosim
