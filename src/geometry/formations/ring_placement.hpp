// Objects on the nodes of a regular pattern around a centre.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "geometry/formations/task.hpp"

namespace pogosim {

/// Nodes in rings around a centre; those of ring k are at least k steps from it.
struct RingPattern {
    float step_mm;
    std::function<std::vector<Vec2>(int ring)> nodes;
};

/// Puts each object on the first node, ring after ring, where it fits. Larger objects choose first, and each placement
/// radius has a pattern of its own. Throws ConfigError when the rings have left the arena before all objects stand;
/// `remedy` is the end of its message: what to do.
std::vector<Placement> place_on_rings(PlacementTask const& task, Vec2 centre,
                                      std::function<RingPattern(float radius_mm)> const& pattern_for,
                                      std::string_view remedy);

}  // namespace pogosim
