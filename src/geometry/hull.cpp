#include "geometry/hull.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace pogosim {

namespace {

/// From the corners of a hull to the nearest side of another one.
float from_corners_mm2(Hull const& corners, Hull const& sides) {
    float nearest_mm2 = std::numeric_limits<float>::max();
    for (std::uint32_t i = 0; i < corners.count; ++i) {
        for (std::uint32_t k = 0; k < sides.count; ++k) {
            nearest_mm2 = std::min(nearest_mm2, distance_mm2(side_of(sides, k), corners.corner_mm[i]));
        }
    }
    return nearest_mm2;
}

}  // namespace

Hull hull_of(RoundedPolygon const& part) {
    assert(!part.corners_mm.empty() && part.corners_mm.size() <= kMostCorners);
    Hull hull;
    hull.radius_mm = part.radius_mm;
    Polygon corners = part.corners_mm;
    bool const has_core = corners.size() > 2;
    if (!has_core) {  // one side along the core, and back on the other side, with a side across at each end
        Vec2 const from = corners.front();
        Vec2 const to = corners.back();
        corners = {from, to, to, from};
    }
    hull.count = static_cast<std::uint32_t>(corners.size());
    for (std::uint32_t k = 0; k < hull.count; ++k) {
        Vec2 const way_mm = corners[k + 1 < hull.count ? k + 1 : 0] - corners[k];
        // The square of a tiny length would be 0.
        float const squared_mm2 = squared_length(way_mm);
        float const length_mm = squared_mm2 > 0.0F ? std::sqrt(squared_mm2) : exact::hypot(way_mm.x, way_mm.y);
        Vec2 const along = length_mm > 0.0F ? (1.0F / length_mm) * way_mm : Vec2{1.0F, 0.0F};
        hull.corner_mm[k] = corners[k];
        hull.outwards[k] = {along.y, -along.x};
    }
    for (std::uint32_t k = 1; k < hull.count && !has_core; ++k) {
        Vec2 const before = hull.outwards[k - 1];
        hull.outwards[k] = {-before.y, before.x};
    }
    return hull;
}

Hull placed(Hull const& hull, Vec2 place_mm, Vec2 ahead) {
    Hull result;
    result.count = hull.count;
    result.radius_mm = hull.radius_mm;
    result.centre_mm = place_mm + rotate(hull.centre_mm, ahead);
    result.reach_mm = hull.reach_mm;
    for (std::uint32_t k = 0; k < hull.count; ++k) {
        result.corner_mm[k] = place_mm + rotate(hull.corner_mm[k], ahead);
        result.outwards[k] = rotate(hull.outwards[k], ahead);
    }
    return result;
}

float distance_mm2(Line const& line, Vec2 point_mm) {
    Vec2 const way_mm = line.to_mm - line.from_mm;
    float const length_mm2 = squared_length(way_mm);
    float const share =
        length_mm2 > 0.0F ? std::clamp(dot(point_mm - line.from_mm, way_mm) / length_mm2, 0.0F, 1.0F) : 0.0F;
    return squared_length(point_mm - line.from_mm - share * way_mm);
}

float lowest_mm(Hull const& hull, Vec2 from_mm, Vec2 up) {
    float height_mm = std::numeric_limits<float>::max();
    for (std::uint32_t k = 0; k < hull.count; ++k) {
        height_mm = std::min(height_mm, dot(hull.corner_mm[k] - from_mm, up));
    }
    return height_mm;
}

Furthest furthest_from_side(Hull const& of, Hull const& other) {
    Furthest furthest;
    for (std::uint32_t i = 0; i < of.count && of.count > 1; ++i) {
        float const distance_mm = lowest_mm(other, of.corner_mm[i], of.outwards[i]);
        if (distance_mm > furthest.distance_mm) {
            furthest = {distance_mm, i};
        }
    }
    return furthest;
}

float gap_between_mm(Hull const& a, Hull const& b) {
    assert(a.count > 1 || b.count > 1);
    float const deepest_mm = std::max(furthest_from_side(a, b).distance_mm, furthest_from_side(b, a).distance_mm);
    float const apart_mm =
        deepest_mm > 0.0F ? std::sqrt(std::min(from_corners_mm2(a, b), from_corners_mm2(b, a))) : deepest_mm;
    return apart_mm - a.radius_mm - b.radius_mm;
}

}  // namespace pogosim
