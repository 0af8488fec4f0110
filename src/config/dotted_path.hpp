// Dotted paths into a tree: "objects.robots.nb", "parameters.list.0", `a\.b` for a key that holds a dot.
#pragma once

#include <string>
#include <string_view>

#include "config/tree.hpp"

namespace pogosim {

struct SplitPath {
    std::string first;      // the first key, `\.` turned into a dot
    std::string_view rest;  // behind the dot that follows it
    bool last = true;       // no dot follows: `first` is the whole path
};

SplitPath split_path(std::string_view dotted_path);

/// The entry of a map under `key`, or the item of a sequence at that index; nullptr when there is none.
Node const* child_at(Node const& parent, std::string_view key);
Node* child_at(Node& parent, std::string_view key);

}  // namespace pogosim
