#include "physics/wall_side.hpp"

#include <algorithm>

namespace pogosim {

namespace {

Vec2 unit_vector(WallEdge const& edge) {
    Vec2 const way = edge.to - edge.from;
    float const far = length(way);
    return far > 0.0F ? (1.0F / far) * way : Vec2{1.0F, 0.0F};
}

}  // namespace

WallSides sides_of(WallIndex const& walls) {
    WallSides sides;
    for (WallEdge const& edge : walls.edges()) {
        Vec2 const along = unit_vector(edge);
        Vec2 const along_previous = unit_vector(walls.edges()[edge.previous]);
        sides.push_back({.from_mm = edge.from,
                         .along = along,
                         .normal = {-along.y, along.x},
                         .length_mm = length(edge.to - edge.from),
                         .along_previous = along_previous,
                         .has_corner = cross(along_previous, along) < 0.0F,
                         .ends_in_corner = false});
    }
    for (WallEdge const& edge : walls.edges()) {
        sides[edge.previous].ends_in_corner = sides[edge.number].has_corner;
    }
    return sides;
}

float distance_to(WallSide const& side, Vec2 point_mm) {
    Vec2 const offset = point_mm - side.from_mm;
    float const t = std::clamp(dot(offset, side.along), 0.0F, side.length_mm);
    return length(offset - t * side.along);
}

std::optional<Gap> gap_to(WallSide const& side, Vec2 point_mm) {
    Vec2 const offset = point_mm - side.from_mm;
    float const t = dot(offset, side.along);
    if (t > side.length_mm) {
        return std::nullopt;  // the next edge's
    }
    if (t >= 0.0F) {
        float const distance_mm = dot(offset, side.normal);
        return distance_mm >= 0.0F ? std::optional(Gap{distance_mm, side.normal}) : std::nullopt;
    }
    if (!side.has_corner || dot(offset, side.along_previous) <= 0.0F) {
        return std::nullopt;  // the previous edge's
    }
    float const far = length(offset);
    return far > 0.0F ? Gap{far, (1.0F / far) * offset} : Gap{0.0F, side.normal};
}

}  // namespace pogosim
