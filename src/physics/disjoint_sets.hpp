// Which bodies belong together: trees of a disjoint-set forest, by the parent of each body. The root of a tree is its
// first body.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace pogosim {

/// The root of a body's tree, with path halving: R. E. Tarjan, "Efficiency of a good but not linear set union
/// algorithm", Journal of the ACM 22 (1975) 215.
inline std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t body) {
    while (parent[body] != body) {
        body = parent[body] = parent[parent[body]];
    }
    return body;
}

/// Joins the trees of two bodies.
inline void unite(std::vector<std::uint32_t>& parent, std::uint32_t a, std::uint32_t b) {
    std::uint32_t const root_a = root_of(parent, a);
    std::uint32_t const root_b = root_of(parent, b);
    parent[std::max(root_a, root_b)] = std::min(root_a, root_b);
}

}  // namespace pogosim
