#include "geometry/obstacle.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace pogosim {

namespace {

constexpr int kPointsOnLine = 256;  // besides its corners

std::vector<Vec2> points_on_line(Polygon const& line) {
    std::vector<Vec2> points = line;
    if (line.size() > 1) {
        std::ranges::copy(spread_along(line, kPointsOnLine), std::back_inserter(points));
    }
    return points;
}

/// How deep the line of `a`, with its thickness, reaches into `b`; negative when they are apart.
float reach_into(Obstacle const& a, Obstacle const& b) {
    float least_gap = std::numeric_limits<float>::infinity();
    for (Vec2 const point : points_on_line(a.line)) {
        least_gap = std::min(least_gap, gap_mm(b, point));
    }
    return a.half_thickness_mm - least_gap;
}

}  // namespace

std::vector<Obstacle> solid_obstacles(std::string const& name, Shape const& shape, Vec2 position_mm,
                                      float heading_rad) {
    std::vector<Obstacle> obstacles;
    for (RoundedPolygon const& part : convex_parts(shape)) {
        obstacles.push_back({.name = name,
                             .line = moved(part.corners_mm, position_mm, heading_rad),
                             .half_thickness_mm = part.radius_mm});
    }
    return obstacles;
}

Obstacle moved_by(Vec2 offset_mm, Obstacle obstacle) {
    for (Vec2& corner : obstacle.line) {
        corner = corner + offset_mm;
    }
    return obstacle;
}

std::vector<Obstacle> images_across(Box const& bounds_mm, Obstacle const& obstacle) {
    Box const box = bounding_box(obstacle.line);
    Vec2 const size = bounds_mm.size();
    float const margin = obstacle.half_thickness_mm;
    std::vector<Obstacle> images;
    for (int const row : {-1, 0, 1}) {
        for (int const column : {-1, 0, 1}) {
            Vec2 const offset{static_cast<float>(column) * size.x, static_cast<float>(row) * size.y};
            Vec2 const low = box.min + offset - Vec2{margin, margin};
            Vec2 const high = box.max + offset + Vec2{margin, margin};
            bool const reaches_in = low.x < bounds_mm.max.x && high.x > bounds_mm.min.x && low.y < bounds_mm.max.y &&
                                    high.y > bounds_mm.min.y;
            if (reaches_in && (row != 0 || column != 0)) {
                images.push_back(moved_by(offset, obstacle));
            }
        }
    }
    return images;
}

float gap_mm(Obstacle const& obstacle, Vec2 point_mm) {
    float const to_line_mm = distance_to_outline(obstacle.line, point_mm);
    bool const enclosed = obstacle.solid && contains(obstacle.line, point_mm);
    return (enclosed ? -to_line_mm : to_line_mm) - obstacle.half_thickness_mm;
}

float overlap_mm(Obstacle const& a, Obstacle const& b) {
    return std::max({reach_into(a, b), reach_into(b, a), 0.0F});
}

float overlap_mm(Obstacle const& obstacle, Arena const& arena) {
    float deepest = 0.0F;
    for (Vec2 const point : points_on_line(obstacle.line)) {
        float const to_walls_mm = arena.distance_to_walls(point);
        float const beyond_mm = arena.contains(point) ? -to_walls_mm : to_walls_mm;
        deepest = std::max(deepest, beyond_mm + obstacle.half_thickness_mm);
    }
    // A hole may lie within the obstacle.
    for (std::size_t hole = 1; hole < arena.polygons.size(); ++hole) {
        deepest = std::max(deepest, reach_into({.name = {}, .line = arena.polygons[hole]}, obstacle));
    }
    return deepest;
}

}  // namespace pogosim
