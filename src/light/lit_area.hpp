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

/// The point, or that of its images across the borders of a periodic map that is nearest to the centre.
Vec2 nearest_image(LightMap const& map, Vec2 centre_mm, Vec2 point_mm);

/// Calls visit(cell, its centre) for the cells whose centre lies in the shape at `centre_mm`. Arena counts as
/// everywhere, as in contains(). In a periodic map, the image of each cell counts that is nearest to `centre_mm`.
template <class Visit>
void for_each_cell_in(Shape const& shape, Vec2 centre_mm, LightMap const& map, Visit const& visit);

/// A cell, and where its centre is as seen from a lamp: in a periodic map, that may be beyond its borders.
struct LitCell {
    std::uint32_t cell;
    Vec2 centre_mm;
};

/// The same cells as a list, for arena those inside any of its polygons (holes included).
std::vector<LitCell> lit_cells(Shape const& shape, Vec2 centre_mm, Arena const& arena, LightMap const& map);

/// The point to which the images of cells are nearest: the lamp; for global and arena, the middle of what it lights
/// (its centre counts from that of the arena's bounding box).
Vec2 middle_of_light(Shape const& shape, Vec2 centre_mm, Arena const& arena);

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

/// Cells along one axis of a periodic map, counted on across its borders: `first` to `last`, each at most once.
struct ImageRange {
    std::int64_t first;
    std::int64_t last;

    /// The cell of the map.
    static std::uint32_t cell(std::int64_t image, int count) {
        std::int64_t const rest = image % count;
        return static_cast<std::uint32_t>(rest < 0 ? rest + count : rest);
    }
};

/// The images nearest to `middle` whose centre may lie between `low` and `high`, counted in cells.
inline ImageRange images_between(float low, float high, float middle, int count) {
    constexpr double kRounding = 1e-3;  // with the lamp in the middle of the map, all cells are where they are
    auto const nearest = static_cast<std::int64_t>(std::ceil(middle - 0.5 * count - 0.5 - kRounding));
    return {std::max(nearest, static_cast<std::int64_t>(std::floor(low)) - 1),
            std::min(nearest + count - 1, static_cast<std::int64_t>(std::floor(high)) + 1)};
}

template <class Visit>
void for_each_image_in(Shape const& shape, Vec2 centre_mm, LightMap const& map, Visit const& visit) {
    bool const everywhere = is_everywhere(shape);
    Vec2 const size_mm{static_cast<float>(map.columns) * map.cell_mm.x, static_cast<float>(map.rows) * map.cell_mm.y};
    Box const box = everywhere ? Box{-1.0F * size_mm, size_mm} : bounding_box(shape);
    Vec2 const middle = centre_mm - map.origin_mm;
    Vec2 const low = box.min + middle;
    Vec2 const high = box.max + middle;
    ImageRange const columns =
        images_between(low.x / map.cell_mm.x, high.x / map.cell_mm.x, middle.x / map.cell_mm.x, map.columns);
    ImageRange const rows =
        images_between(low.y / map.cell_mm.y, high.y / map.cell_mm.y, middle.y / map.cell_mm.y, map.rows);
    for (std::int64_t row = rows.first; row <= rows.last; ++row) {
        std::uint32_t const row_start = ImageRange::cell(row, map.rows) * static_cast<std::uint32_t>(map.columns);
        for (std::int64_t column = columns.first; column <= columns.last; ++column) {
            Vec2 const centre = map.origin_mm + Vec2{(static_cast<float>(column) + 0.5F) * map.cell_mm.x,
                                                     (static_cast<float>(row) + 0.5F) * map.cell_mm.y};
            if (everywhere || contains(shape, centre - centre_mm)) {
                visit(row_start + ImageRange::cell(column, map.columns), centre);
            }
        }
    }
}

template <class Visit>
void for_each_cell_in(Shape const& shape, Vec2 centre_mm, LightMap const& map, Visit const& visit) {
    if (map.periodic) {
        for_each_image_in(shape, centre_mm, map, visit);
        return;
    }
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
