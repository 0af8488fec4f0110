// The part of the light map that a lamp can light.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "geometry/arena.hpp"
#include "geometry/shape.hpp"
#include "world/world.hpp"

namespace pogosim {

inline Vec2 cell_centre_mm(LightMap const& map, int column, int row) {
    return map.origin_mm +
           Vec2{(static_cast<float>(column) + 0.5F) * map.cell_mm.x, (static_cast<float>(row) + 0.5F) * map.cell_mm.y};
}
inline Vec2 cell_centre_mm(LightMap const& map, std::uint32_t cell) {
    auto const columns = static_cast<std::uint32_t>(map.columns);
    return cell_centre_mm(map, static_cast<int>(cell % columns), static_cast<int>(cell / columns));
}

/// Calls visit(cell, its centre) for the cells whose centre lies in the shape at `centre_mm`, in the order of the map.
/// Arena counts as everywhere, as in contains().
template <class Visit>
void for_each_cell_in(Shape const& shape, Vec2 centre_mm, LightMap const& map, Visit const& visit);

/// The same cells as a list, for arena those inside any of its polygons (holes included).
std::vector<std::uint32_t> lit_cells(Shape const& shape, Vec2 centre_mm, Arena const& arena, LightMap const& map);

/// Box around what a lamp at `centre_mm` can light: around its shape, or for global and arena the arena's bounding box,
/// from whose centre `centre_mm` counts then.
Box lit_box(Shape const& shape, Vec2 centre_mm, Arena const& arena);

/// First and last of `count` cells along an axis whose centre may lie between `low` and `high`, counted in cells; one
/// more to either side, against rounding. Empty (first > last) when the interval is outside.
struct CellRange {
    int first;
    int last;
};
inline CellRange cells_between(float low, float high, int count) {
    auto const end = static_cast<float>(count);
    return {static_cast<int>(std::clamp(std::floor(low) - 1.0F, 0.0F, end)),
            static_cast<int>(std::clamp(std::floor(high) + 1.0F, -1.0F, end - 1.0F))};
}

template <class Visit>
void for_each_cell_in(Shape const& shape, Vec2 centre_mm, LightMap const& map, Visit const& visit) {
    bool const everywhere = is_everywhere(shape);
    CellRange columns{0, map.columns - 1};
    CellRange rows{0, map.rows - 1};
    if (!everywhere) {
        Box const box = bounding_box(shape);
        Vec2 const low = box.min + centre_mm - map.origin_mm;
        Vec2 const high = box.max + centre_mm - map.origin_mm;
        columns = cells_between(low.x / map.cell_mm.x, high.x / map.cell_mm.x, map.columns);
        rows = cells_between(low.y / map.cell_mm.y, high.y / map.cell_mm.y, map.rows);
    }
    for (int row = rows.first; row <= rows.last; ++row) {
        auto const row_start = static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(map.columns);
        for (int column = columns.first; column <= columns.last; ++column) {
            Vec2 const centre = cell_centre_mm(map, column, row);
            if (everywhere || contains(shape, centre - centre_mm)) {
                visit(row_start + static_cast<std::uint32_t>(column), centre);
            }
        }
    }
}

}  // namespace pogosim
