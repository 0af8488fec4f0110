// Lamps and the light map they make.
#pragma once

#include <cstdint>
#include <vector>

#include "world/world.hpp"

namespace pogosim {

/// Level one lamp adds at a point, sensor counts of 0 to 32767, at `time_s`.
int lamp_level(LampSpec const& lamp, Arena const& arena, Vec2 point_mm, double time_s);

/// An empty map of the given number of cells over the arena's bounding box.
LightMap make_light_map(Arena const& arena, int columns, int rows);

/// All lamps of a run. Keeps the world's light map up to date.
class Lighting {
public:
    explicit Lighting(std::vector<LampSpec> lamps) : lamps_(std::move(lamps)) {}

    /// Writes world.light for the present time, if any lamp has changed since the last call. Lamps add up to 32767.
    void update(World& world);

private:
    std::vector<LampSpec> lamps_;
    std::vector<int> shown_phases_;  // of each lamp, as the map shows them; empty before the first update
};

}  // namespace pogosim
