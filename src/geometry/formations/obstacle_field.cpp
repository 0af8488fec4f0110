#include "geometry/formations/obstacle_field.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace pogosim {

namespace {

constexpr float kLeastPushMm = 1.0e-3F;

std::size_t count_edges(std::span<Obstacle const> obstacles) {
    std::size_t count = 0;
    for (Obstacle const& obstacle : obstacles) {
        count += obstacle.line.size();
    }
    return count;
}

}  // namespace

ObstacleField::ObstacleField(std::span<Obstacle const> obstacles, Box bounds_mm)
    : bands_(bounds_mm, count_edges(obstacles)) {
    std::ranges::for_each(obstacles, [this](Obstacle const& obstacle) { add_edges(obstacle); });
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
        auto const [top, bottom] = std::minmax(edges_[e].from.y, edges_[e].to.y);
        bands_.add(e, top - edges_[e].half_thickness_mm, bottom + edges_[e].half_thickness_mm);
    }
}

void ObstacleField::add_edges(Obstacle const& obstacle) {
    Polygon line = obstacle.line;
    if (signed_area(line) < 0.0) {
        std::ranges::reverse(line);
    }
    for (std::size_t i = 0; i < line.size(); ++i) {
        edges_.push_back({line[i], line[(i + 1) % line.size()], obstacle.half_thickness_mm, obstacle.solid});
    }
}

/// By the winding number: all solid outlines run the same way round, so that where they overlap it only grows, while
/// counting crossings by pairs would call such a place free.
bool ObstacleField::is_enclosed(Vec2 point) const {
    int winding = 0;
    for (std::uint32_t const e : bands_.at(point.y)) {
        Edge const& edge = edges_[e];
        if (edge.solid && ray_crosses(edge.from, edge.to, point)) {
            winding += edge.from.y < edge.to.y ? 1 : -1;
        }
    }
    return winding != 0;
}

bool ObstacleField::is_clear(Vec2 centre_mm, float radius_mm) const {
    if (edges_.empty()) {
        return true;
    }
    bool clear = !is_enclosed(centre_mm);
    bands_.for_each_between(centre_mm.y - radius_mm, centre_mm.y + radius_mm, [&](std::uint32_t e) {
        if (clear) {
            Edge const& edge = edges_[e];
            float const apart_mm = radius_mm + edge.half_thickness_mm;
            Vec2 const foot = nearest_on_segment(edge.from, edge.to, centre_mm);
            clear = squared_length(centre_mm - foot) >= apart_mm * apart_mm;
        }
    });
    return clear;
}

/// The place just clear of the edge, on the side of the point or across.
Vec2 ObstacleField::beside(Edge const& edge, Vec2 point, float radius_mm, bool across) {
    Vec2 const foot = nearest_on_segment(edge.from, edge.to, point);
    Vec2 const away = across ? foot - point : point - foot;
    float const distance_mm = length(away);
    Vec2 const along = edge.to - edge.from;
    float const length_mm = length(along);
    // Seen along an edge that runs clockwise on the screen, outside is where -y is from +x.
    Vec2 const normal = length_mm > 0.0F ? (1.0F / length_mm) * Vec2{along.y, -along.x} : Vec2{1.0F, 0.0F};
    Vec2 const unit = distance_mm > 0.0F ? (1.0F / distance_mm) * away : normal;
    return foot + std::max(kPushMargin * (radius_mm + edge.half_thickness_mm), kLeastPushMm) * unit;
}

/// To the nearest side from which it is out of all solid ones.
std::optional<Vec2> ObstacleField::pushed_out(Vec2 centre, float radius_mm) const {
    std::optional<Vec2> nearest;
    float nearest_squared = std::numeric_limits<float>::infinity();
    for (Edge const& edge : edges_) {
        Vec2 const place = edge.solid ? beside(edge, centre, radius_mm, true) : centre;
        float const squared = squared_length(place - centre);
        if (edge.solid && squared < nearest_squared && !is_enclosed(place)) {
            nearest = place;
            nearest_squared = squared;
        }
    }
    return nearest;
}

std::optional<Vec2> ObstacleField::pushed_off(Vec2 centre_mm, float radius_mm) const {
    if (edges_.empty()) {
        return std::nullopt;
    }
    if (is_enclosed(centre_mm)) {
        return pushed_out(centre_mm, radius_mm);
    }
    Edge const* nearest = nullptr;
    float least_gap_mm = radius_mm;
    bands_.for_each_between(centre_mm.y - radius_mm, centre_mm.y + radius_mm, [&](std::uint32_t e) {
        Edge const& edge = edges_[e];
        float const to_line_mm = length(centre_mm - nearest_on_segment(edge.from, edge.to, centre_mm));
        if (to_line_mm - edge.half_thickness_mm < least_gap_mm) {
            least_gap_mm = to_line_mm - edge.half_thickness_mm;
            nearest = &edge;
        }
    });
    return nearest == nullptr ? std::nullopt : std::optional(beside(*nearest, centre_mm, radius_mm, false));
}

}  // namespace pogosim
