// Which bodies belong together: trees of a disjoint-set forest, by the parent of each body. The root of a tree is its
// first body, and no parent comes after its child.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace pogosim {

/// Joins the trees of two bodies: Rem's algorithm, which climbs both trees at once. E. W. Dijkstra, "A Discipline of
/// Programming", Prentice-Hall 1976, chapter 23.
inline void unite(std::vector<std::uint32_t>& parent, std::uint32_t a, std::uint32_t b) {
    while (parent[a] != parent[b]) {
        if (parent[a] < parent[b]) {
            std::swap(a, b);
        }
        std::uint32_t const next = std::exchange(parent[a], parent[b]);
        if (next == a) {
            return;  // it was a root
        }
        a = next;
    }
}

/// Makes the parent of each body its root. Branch-free, since parents come before their children.
inline void flatten(std::vector<std::uint32_t>& parent) {
    for (std::uint32_t& of_body : parent) {
        of_body = parent[of_body];
    }
}

}  // namespace pogosim
