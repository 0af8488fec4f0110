#include "light/lit_area.hpp"

namespace pogosim {

std::vector<std::uint32_t> lit_cells(Shape const& shape, Vec2 centre_mm, Arena const& arena, LightMap const& map) {
    std::vector<std::uint32_t> cells;
    for_each_cell_in(shape, centre_mm, map, [&](std::uint32_t cell, Vec2 point_mm) {
        bool const inside =
            shape.kind != ShapeKind::arena ||
            std::ranges::any_of(arena.polygons, [&](Polygon const& polygon) { return contains(polygon, point_mm); });
        if (inside) {
            cells.push_back(cell);
        }
    });
    return cells;
}

Box lit_box(Shape const& shape, Vec2 centre_mm, Arena const& arena) {
    Box const box = is_everywhere(shape) ? arena.bounds : bounding_box(shape);
    return {box.min + centre_mm, box.max + centre_mm};
}

}  // namespace pogosim
