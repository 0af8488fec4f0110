#include "physics/wall_neighbour_list.hpp"

#include <algorithm>

namespace pogosim {

namespace {

Vec2 unit_vector(WallEdge const& edge) {
    Vec2 const way = edge.to - edge.from;
    float const far = length(way);
    return far > 0.0F ? (1.0F / far) * way : Vec2{1.0F, 0.0F};
}

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

}  // namespace

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

WallNeighbourList::WallNeighbourList(World const& world, WallIndex const& walls)
    : sides_(std::make_shared<WallSides const>(world.periodic ? WallSides() : sides_of(walls))) {}

void WallNeighbourList::build(World const& world, PositionCorrection const& places, float skin_mm) {
    near_.clear();
    if (sides_->empty()) {
        return;
    }
    Bodies const& bodies = world.bodies;
    for (std::uint32_t body = 0; body < bodies.size(); ++body) {
        float const reach_mm = bodies.radius_mm[body] + skin_mm;
        if (bodies.spec[body].fixed || places.free_mm(body) > reach_mm) {
            continue;
        }
        Vec2 const place_mm = bodies.position_mm[body];
        found_.clear();
        places.walls().for_each_near(place_mm, reach_mm, [&](WallEdge const& edge) {
            if (distance_to(side(edge.number), place_mm) < reach_mm &&
                std::ranges::find(found_, edge.number) == found_.end()) {
                found_.push_back(edge.number);
            }
        });
        std::ranges::sort(found_);
        for (std::uint32_t const edge : found_) {
            near_.push_back({body, edge});
        }
    }
}

}  // namespace pogosim
