#include "geometry/arena.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "base/error.hpp"

namespace pogosim {

namespace {

double net_area(std::vector<Polygon> const& polygons) {
    double area = 2.0 * std::abs(signed_area(polygons.front()));
    for (Polygon const& polygon : polygons) {
        area -= std::abs(signed_area(polygon));
    }
    return area;
}

double checked_net_area(std::vector<Polygon> const& polygons, std::string const& source) {
    double const area = net_area(polygons);
    if (!(area > 0.0 && std::isfinite(area))) {
        throw ConfigError(
            fmt::format("{}: the outer polygon less the holes has an area of {:g}, which must be positive. "
                        "The first polygon must be the outer one",
                        source, area));
    }
    return area;
}

}  // namespace

Box bounding_box_of_all(std::vector<Polygon> const& polygons) {
    Polygon corners;
    for (Polygon const& polygon : polygons) {
        corners.insert(corners.end(), polygon.begin(), polygon.end());
    }
    return bounding_box(corners);
}

bool Arena::contains(Vec2 point_mm) const {
    return pogosim::contains(outer(), point_mm) &&
           std::none_of(polygons.begin() + 1, polygons.end(),
                        [&](Polygon const& hole) { return pogosim::contains(hole, point_mm); });
}

float Arena::distance_to_walls(Vec2 point_mm) const {
    float nearest = std::numeric_limits<float>::infinity();
    for (Polygon const& polygon : polygons) {
        nearest = std::min(nearest, distance_to_outline(polygon, point_mm));
    }
    return nearest;
}

std::string arena_text(Arena const& arena) {
    Box const& box = arena.bounds;
    return fmt::format("the arena, which extends from ({:.1f}, {:.1f}) to ({:.1f}, {:.1f}) mm", box.min.x, box.min.y,
                       box.max.x, box.max.y);
}

Arena make_arena(std::vector<Polygon> polygons_mm) {
    assert(!polygons_mm.empty());
    double const area = checked_net_area(polygons_mm, "arena");
    Box const bounds = bounding_box(polygons_mm.front());
    return {std::move(polygons_mm), bounds, area};
}

Arena scale_arena(ArenaOutline const& outline, ArenaScaling const& scaling) {
    assert(!outline.polygons.empty());
    assert(!scaling.surface_mm2 || *scaling.surface_mm2 > 0.0);
    double const area = checked_net_area(outline.polygons, outline.source);
    Box const box = bounding_box_of_all(outline.polygons);
    double const width = static_cast<double>(box.max.x) - box.min.x;
    double const height = static_cast<double>(box.max.y) - box.min.y;

    // One factor per axis; the product of both turns the outline's area into the one asked for.
    double const aspect = scaling.stretch && scaling.surface_mm2 ? height / width : 1.0;
    double const scale_y = std::sqrt(scaling.surface_mm2.value_or(area) / area / aspect);
    double const scale_x = scale_y * aspect;

    std::vector<Polygon> scaled = outline.polygons;
    for (Polygon& polygon : scaled) {
        for (Vec2& corner : polygon) {
            corner = {static_cast<float>((static_cast<double>(corner.x) - box.min.x) * scale_x),
                      static_cast<float>((static_cast<double>(corner.y) - box.min.y) * scale_y)};
        }
    }
    return make_arena(std::move(scaled));
}

}  // namespace pogosim
