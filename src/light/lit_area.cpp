#include "light/lit_area.hpp"

namespace pogosim {

Vec2 nearest_image(LightMap const& map, Vec2 centre_mm, Vec2 point_mm) {
    if (!map.periodic) {
        return point_mm;
    }
    Vec2 const offset = point_mm - centre_mm;
    Vec2 const size{static_cast<float>(map.columns) * map.cell_mm.x, static_cast<float>(map.rows) * map.cell_mm.y};
    return point_mm - Vec2{size.x * std::round(offset.x / size.x), size.y * std::round(offset.y / size.y)};
}

std::vector<LitCell> lit_cells(Shape const& shape, Vec2 centre_mm, Arena const& arena, LightMap const& map) {
    std::vector<LitCell> cells;
    for_each_cell_in(shape, middle_of_light(shape, centre_mm, arena), map, [&](std::uint32_t cell, Vec2 point_mm) {
        Vec2 const on_map_mm = cell_centre_mm(map, cell);
        bool const inside =
            shape.kind != ShapeKind::arena ||
            std::ranges::any_of(arena.polygons, [&](Polygon const& polygon) { return contains(polygon, on_map_mm); });
        if (inside) {
            cells.push_back({cell, point_mm});
        }
    });
    return cells;
}

Vec2 middle_of_light(Shape const& shape, Vec2 centre_mm, Arena const& arena) {
    return is_everywhere(shape) ? arena.bounds.centre() + centre_mm : centre_mm;
}

Box lit_box(Shape const& shape, Vec2 centre_mm, Arena const& arena) {
    Box const box = is_everywhere(shape) ? arena.bounds : bounding_box(shape);
    return {box.min + centre_mm, box.max + centre_mm};
}

}  // namespace pogosim
