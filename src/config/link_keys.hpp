// `links`: springs, rods and hinges between objects.
#pragma once

#include <string_view>
#include <vector>

#include "config/map_reader.hpp"
#include "config/scenario.hpp"

namespace pogosim {

inline constexpr std::string_view kLinksMap =
    "a map of links, such as {skeleton: {between: robots, topology: triangular}}";

/// The key `links` of the top level. Returns its values.
Node read_links(MapReader const& top, std::vector<LinkConfig>& links);

/// Lines of the reference: the keys of an entry.
std::vector<KeyDescription> link_keys_reference();

}  // namespace pogosim
