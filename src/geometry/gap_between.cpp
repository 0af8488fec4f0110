#include "geometry/gap_between.hpp"

#include <algorithm>
#include <limits>

namespace pogosim {

namespace {

/// Whether two segments cross, ends not counted.
bool cross_each_other(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
    auto const side = [](Vec2 from, Vec2 to, Vec2 point) { return cross(to - from, point - from); };
    return side(a, b, c) * side(a, b, d) < 0.0F && side(c, d, a) * side(c, d, b) < 0.0F;
}

bool overlap(Polygon const& a, Polygon const& b) {
    if (contains(a, b.front()) || contains(b, a.front())) {
        return true;
    }
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t k = 0; k < b.size(); ++k) {
            if (cross_each_other(a[i], a[(i + 1) % a.size()], b[k], b[(k + 1) % b.size()])) {
                return true;
            }
        }
    }
    return false;
}

/// From the corners of one to the sides of the other, which is the shortest if they do not overlap.
float from_corners(Polygon const& corners, Polygon const& sides) {
    float nearest = std::numeric_limits<float>::max();
    for (Vec2 const corner : corners) {
        nearest = std::min(nearest, distance_to_outline(sides, corner));
    }
    return nearest;
}

}  // namespace

float gap_between(RoundedPolygon const& a, RoundedPolygon const& b) {
    if (overlap(a.corners_mm, b.corners_mm)) {
        return 0.0F;
    }
    float const between_cores =
        std::min(from_corners(a.corners_mm, b.corners_mm), from_corners(b.corners_mm, a.corners_mm));
    return std::max(between_cores - a.radius_mm - b.radius_mm, 0.0F);
}

}  // namespace pogosim
