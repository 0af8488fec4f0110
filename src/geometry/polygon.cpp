#include "geometry/polygon.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace pogosim {

namespace {

/// Calls visit(a, b) for every edge.
template <typename Visit>
void for_each_edge(std::span<Vec2 const> polygon, Visit visit) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        visit(polygon[i], polygon[(i + 1) % polygon.size()]);
    }
}

/// Sums over the triangles from the first corner to each edge: doubled area, and moment of the area about that corner.
struct Moments {
    double doubled_area = 0.0;
    double x = 0.0;
    double y = 0.0;
};

Moments moments(std::span<Vec2 const> polygon) {
    Moments sum;
    for_each_edge(polygon, [&](Vec2 a, Vec2 b) {
        double const ax = static_cast<double>(a.x) - polygon[0].x;
        double const ay = static_cast<double>(a.y) - polygon[0].y;
        double const bx = static_cast<double>(b.x) - polygon[0].x;
        double const by = static_cast<double>(b.y) - polygon[0].y;
        double const doubled = ax * by - ay * bx;
        sum.doubled_area += doubled;
        sum.x += doubled * (ax + bx) / 3.0;
        sum.y += doubled * (ay + by) / 3.0;
    });
    return sum;
}

}  // namespace

double signed_area(std::span<Vec2 const> polygon) {
    return 0.5 * moments(polygon).doubled_area;
}

Vec2 centroid(std::span<Vec2 const> polygon) {
    Moments const sum = moments(polygon);
    assert(sum.doubled_area != 0.0);
    return {static_cast<float>(polygon[0].x + sum.x / sum.doubled_area),
            static_cast<float>(polygon[0].y + sum.y / sum.doubled_area)};
}

bool contains(std::span<Vec2 const> polygon, Vec2 point) {
    bool inside = false;
    for_each_edge(polygon, [&](Vec2 a, Vec2 b) { inside ^= ray_crosses(a, b, point); });
    return inside;
}

bool ray_crosses(Vec2 a, Vec2 b, Vec2 point) {
    if ((a.y > point.y) == (b.y > point.y)) {
        return false;
    }
    double const slope = (static_cast<double>(b.x) - a.x) / (static_cast<double>(b.y) - a.y);
    return point.x < a.x + slope * (static_cast<double>(point.y) - a.y);
}

Vec2 nearest_on_segment(Vec2 a, Vec2 b, Vec2 point) {
    Vec2 const along = b - a;
    float const squared = squared_length(along);
    float const fraction = squared > 0.0F ? std::clamp(dot(point - a, along) / squared, 0.0F, 1.0F) : 0.0F;
    return a + fraction * along;
}

float distance_to_outline(std::span<Vec2 const> polygon, Vec2 point) {
    assert(!polygon.empty());
    float nearest = std::numeric_limits<float>::infinity();
    for_each_edge(polygon, [&](Vec2 a, Vec2 b) {
        nearest = std::min(nearest, squared_length(point - nearest_on_segment(a, b, point)));
    });
    return std::sqrt(nearest);
}

std::vector<Vec2> spread_along(std::span<Vec2 const> polygon, int count) {
    std::vector<double> starts{0.0};  // of each edge, along the outline
    for_each_edge(polygon,
                  [&](Vec2 a, Vec2 b) { starts.push_back(starts.back() + static_cast<double>(length(b - a))); });
    std::vector<Vec2> points;
    std::size_t edge = 0;
    for (int n = 0; n < count; ++n) {
        double const along = starts.back() * n / count;
        while (edge + 1 < polygon.size() && starts[edge + 1] <= along) {
            ++edge;
        }
        auto const share = static_cast<float>((along - starts[edge]) / (starts[edge + 1] - starts[edge]));
        points.push_back(polygon[edge] + share * (polygon[(edge + 1) % polygon.size()] - polygon[edge]));
    }
    return points;
}

Polygon moved(std::span<Vec2 const> polygon, Vec2 offset, float heading_rad) {
    Vec2 const unit = direction(heading_rad);
    Polygon result;
    for (Vec2 const corner : polygon) {
        result.push_back(rotate(corner, unit) + offset);
    }
    return result;
}

Box bounding_box(std::span<Vec2 const> polygon) {
    assert(!polygon.empty());
    Box box{polygon[0], polygon[0]};
    for (Vec2 const corner : polygon) {
        box.min = {std::min(box.min.x, corner.x), std::min(box.min.y, corner.y)};
        box.max = {std::max(box.max.x, corner.x), std::max(box.max.y, corner.y)};
    }
    return box;
}

}  // namespace pogosim
