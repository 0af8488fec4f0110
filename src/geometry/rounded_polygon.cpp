#include "geometry/rounded_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/exact_math.hpp"

namespace pogosim {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

/// Unit vector along the way; +x where there is none.
Vec2 along(Vec2 way) {
    float const distance = exact::hypot(way.x, way.y);
    return distance > 0.0F ? (1.0F / distance) * way : Vec2{1.0F, 0.0F};
}

/// Unit vector out of a side. The two sides of a capsule have opposite ones.
Vec2 outwards(Polygon const& corners, std::size_t side) {
    Vec2 const way = along(corners[(side + 1) % corners.size()] - corners[side]);
    return {way.y, -way.x};
}

/// The same area and its second moment about its own centre of mass, moved to `centre`.
AreaMoments at(double x, double y, double area, double own_polar) {
    return {area, area * x, area * y, own_polar + area * (x * x + y * y)};
}

/// A triangle with a corner in the origin; the sign is that of its winding.
AreaMoments triangle(Vec2 a, Vec2 b) {
    double const ax = a.x;
    double const ay = a.y;
    double const bx = b.x;
    double const by = b.y;
    double const area = 0.5 * (ax * by - ay * bx);
    double const squares = ax * ax + ay * ay + bx * bx + by * by + ax * bx + ay * by;
    return {area, area * (ax + bx) / 3.0, area * (ay + by) / 3.0, area * squares / 6.0};
}

/// The strip outside a side.
AreaMoments strip(Vec2 from, Vec2 to, Vec2 out, double width) {
    double const length = std::hypot(static_cast<double>(to.x) - from.x, static_cast<double>(to.y) - from.y);
    double const x = 0.5 * (static_cast<double>(from.x) + to.x + width * out.x);
    double const y = 0.5 * (static_cast<double>(from.y) + to.y + width * out.y);
    double const area = length * width;
    return at(x, y, area, area * (length * length + width * width) / 12.0);
}

/// By how much the direction out of the border turns at a corner, 0 to pi.
double turn_at(Vec2 out_before, Vec2 out_after) {
    return std::abs(exact::atan2(cross(out_before, out_after), dot(out_before, out_after)));
}

/// The sector around a corner, between the directions out of its two sides.
AreaMoments sector(Vec2 corner, Vec2 out_before, Vec2 out_after, double radius, double opening) {
    double const area = 0.5 * opening * radius * radius;
    double const cube = radius * radius * radius / 3.0;
    double const own_x = cube * (static_cast<double>(out_after.y) - out_before.y);
    double const own_y = cube * (static_cast<double>(out_before.x) - out_after.x);
    double const x = corner.x;
    double const y = corner.y;
    return {area, area * x + own_x, area * y + own_y,
            area * (x * x + y * y) + 2.0 * (x * own_x + y * own_y) + 0.5 * area * radius * radius};
}

/// What of a convex polygon is not beyond the line through `from` with this unit vector out of it.
Polygon cut(Polygon const& corners, Vec2 from, Vec2 out) {
    Polygon kept;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        Vec2 const a = corners[i];
        Vec2 const b = corners[(i + 1) % corners.size()];
        float const beyond_a = dot(a - from, out);
        float const beyond_b = dot(b - from, out);
        if (beyond_a <= 0.0F) {
            kept.push_back(a);
        }
        if ((beyond_a < 0.0F && beyond_b > 0.0F) || (beyond_a > 0.0F && beyond_b < 0.0F)) {
            kept.push_back(a + (beyond_a / (beyond_a - beyond_b)) * (b - a));
        }
    }
    return kept.size() < 3 ? Polygon() : kept;
}

/// Where the moved sides before and after a corner meet.
Vec2 mitre(Polygon const& corners, std::size_t corner, float out_mm) {
    Vec2 const before = outwards(corners, (corner + corners.size() - 1) % corners.size());
    Vec2 const after = outwards(corners, corner);
    return corners[corner] + (out_mm / (1.0F + dot(before, after))) * (before + after);
}

}  // namespace

AreaMoments operator+(AreaMoments const& a, AreaMoments const& b) {
    return {a.area_mm2 + b.area_mm2, a.x_mm3 + b.x_mm3, a.y_mm3 + b.y_mm3, a.polar_mm4 + b.polar_mm4};
}

AreaMoments moments_of(RoundedPolygon const& part) {
    Polygon const& corners = part.corners_mm;
    AreaMoments sum;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        std::size_t const next = (i + 1) % corners.size();
        sum = sum + triangle(corners[i], corners[next]);
        if (part.radius_mm > 0.0F) {
            Vec2 const out = outwards(corners, i);
            Vec2 const out_next = outwards(corners, next);
            sum = sum + strip(corners[i], corners[next], out, part.radius_mm) +
                  sector(corners[next], out, out_next, part.radius_mm,
                         corners.size() == 1 ? kTurn : turn_at(out, out_next));
        }
    }
    return sum;
}

Polygon outline(RoundedPolygon const& part, int disk_corners) {
    Polygon const& corners = part.corners_mm;
    if (part.radius_mm == 0.0F) {
        return corners;
    }
    Polygon line;
    if (corners.size() == 1) {
        for (int i = 0; i < disk_corners; ++i) {
            float const turn = static_cast<float>(i) / static_cast<float>(disk_corners);
            line.push_back(corners[0] + part.radius_mm * direction(2.0F * std::numbers::pi_v<float> * turn));
        }
        return line;
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
        Vec2 const before = outwards(corners, (i + corners.size() - 1) % corners.size());
        double const opening = turn_at(before, outwards(corners, i));
        int const pieces = std::max(1, static_cast<int>(std::ceil(opening / kTurn * disk_corners - 1e-3)));
        for (int k = 0; k <= pieces; ++k) {
            Vec2 const out = rotate(before, direction(static_cast<float>(opening * k / pieces)));
            line.push_back(corners[i] + part.radius_mm * out);
        }
    }
    return line;
}

bool contains(RoundedPolygon const& part, Vec2 point_mm) {
    return distance_to_outline(part.corners_mm, point_mm) <= part.radius_mm || contains(part.corners_mm, point_mm);
}

RoundedPolygon moved(RoundedPolygon const& part, Vec2 offset_mm, float turn_rad) {
    return {moved(part.corners_mm, offset_mm, turn_rad), part.radius_mm};
}

Polygon inset(Polygon const& corners_mm, float inwards_mm) {
    Polygon result = corners_mm;
    for (std::size_t i = 0; i < corners_mm.size() && !result.empty(); ++i) {
        if (inwards_mm < 0.0F) {
            result[i] = mitre(corners_mm, i, -inwards_mm);
        } else if (inwards_mm > 0.0F) {
            Vec2 const out = outwards(corners_mm, i);
            result = cut(result, corners_mm[i] - inwards_mm * out, out);
        }
    }
    return result;
}

}  // namespace pogosim
