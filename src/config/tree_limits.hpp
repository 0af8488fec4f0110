// How large a configuration may be. Aliases are copied, so that a few lines could ask for more than any memory.
#pragma once

#include <algorithm>
#include <cstddef>

#include "config/tree.hpp"

namespace pogosim {

inline constexpr std::size_t kMaxDepth = 100;
inline constexpr std::size_t kMaxNodes = 1'000'000;

struct TreeSize {
    std::size_t nodes = 0;
    std::size_t depth = 0;  // 1: a node without children
};

inline TreeSize size_of(Node const& node) {
    TreeSize size{1, 0};
    auto const add = [&size](Node const& child) {
        TreeSize const below = size_of(child);
        size.nodes += below.nodes;
        size.depth = std::max(size.depth, below.depth);
    };
    for (auto const& [key, value] : node.entries) {
        add(value);
    }
    for (Node const& item : node.items) {
        add(item);
    }
    size.depth += 1;
    return size;
}

}  // namespace pogosim
