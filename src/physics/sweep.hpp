// Bodies that go so far in one step that they could jump over others.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/grid.hpp"
#include "physics/fixed_polygons.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Where a body was at the start of a step.
struct Start {
    std::uint32_t body;
    Vec2 position_mm;
};

class Sweep {
public:
    /// Stops fast disks where they meet another body on their straight way through the step; the next step makes the
    /// impact. `fast`: those that go further than others, with the places they come from. All positions are those at
    /// the end of the step, `dt_s` after the start.
    void stop_at_impacts(World& world, FixedPolygons const& polygons, std::span<Start const> fast, float dt_s);

private:
    std::vector<Vec2> starts_mm_;  // of all bodies
    UniformGrid grid_;             // of these
};

}  // namespace pogosim
