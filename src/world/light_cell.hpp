// Which cell of a light map is under a point.
#pragma once

#include <algorithm>
#include <cstddef>

#include "world/world.hpp"

namespace pogosim {

/// Index into LightMap::level; of a point outside the map, the nearest cell.
inline std::size_t cell_under(LightMap const& map, Vec2 point_mm) {
    Vec2 const offset = point_mm - map.origin_mm;
    // Clamped first: converting a float that is too large to an integer gives different results on different
    // processors.
    auto const cell = [](float place, int count) {
        return static_cast<int>(std::clamp(place, 0.0F, static_cast<float>(count - 1)));
    };
    int const column = cell(offset.x / map.cell_mm.x, map.columns);
    int const row = cell(offset.y / map.cell_mm.y, map.rows);
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(map.columns) + static_cast<std::size_t>(column);
}

}  // namespace pogosim
