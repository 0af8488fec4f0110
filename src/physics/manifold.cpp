#include "physics/manifold.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

namespace pogosim {

namespace {

// A side of `a` stays the reference until one of `b` is further out by this, so that touches keep their features.
constexpr float kPreferenceMm = 0.01F;
// Touches that lie closer together than this are one.
constexpr float kSamePlaceMm = 0.01F;

/// The side of a hull that faces against `normal` most.
std::uint32_t side_against(Hull const& hull, Vec2 normal) {
    std::uint32_t best = 0;
    for (std::uint32_t k = 1; k < hull.count; ++k) {
        if (dot(hull.outwards[k], normal) < dot(hull.outwards[best], normal)) {
            best = k;
        }
    }
    return best;
}

/// Where a side (the reference) and another one (incident) touch. `normal`: unit vector out of the reference.
struct Sides {
    Line reference{};
    Line incident{};
    Vec2 normal;
    float reference_radius_mm = 0.0F;
    float incident_radius_mm = 0.0F;
    std::uint32_t features = 0;

    float radius_mm() const { return reference_radius_mm + incident_radius_mm; }
};

/// A touch at a point of the incident side which is `height_mm` above the reference.
ManifoldPoint touch_at(Sides const& sides, Vec2 point_mm, float height_mm, std::uint32_t end) {
    float const down_mm = 0.5F * (height_mm + sides.incident_radius_mm - sides.reference_radius_mm);
    return {.point_mm = point_mm - down_mm * sides.normal,
            .gap_mm = height_mm - sides.radius_mm(),
            .features = sides.features << 1U | end};
}

void add(Manifold& touches, ManifoldPoint const& touch, float reach_mm) {
    bool const is_known =
        touches.count == 1 && squared_length(touches.touch[0].point_mm - touch.point_mm) < kSamePlaceMm * kSamePlaceMm;
    if (touch.gap_mm < reach_mm && !is_known) {
        touches.touch[touches.count++] = touch;
    }
}

/// The part of the incident side above the reference; none if it is beside it. The normal of the touches is that of
/// the sides.
std::optional<Manifold> clipped(Sides const& sides, float reach_mm) {
    Vec2 const way_mm = sides.reference.to_mm - sides.reference.from_mm;
    float const length_mm = length(way_mm);
    Vec2 const along = {-sides.normal.y, sides.normal.x};  // the reference runs clockwise
    Vec2 const from_mm = sides.incident.from_mm - sides.reference.from_mm;
    Vec2 const to_mm = sides.incident.to_mm - sides.reference.from_mm;
    float const from = dot(from_mm, along);
    float const to = dot(to_mm, along);
    if (std::max(from, to) < -kSamePlaceMm || std::min(from, to) > length_mm + kSamePlaceMm) {
        return std::nullopt;
    }
    Manifold touches{.normal = sides.normal};
    auto const add_end = [&](float at, std::uint32_t end) {
        float const held = std::clamp(at, 0.0F, length_mm);
        float const share = from == to ? static_cast<float>(end) : std::clamp((held - from) / (to - from), 0.0F, 1.0F);
        Vec2 const point_mm = from_mm + share * (to_mm - from_mm);
        add(touches, touch_at(sides, sides.reference.from_mm + point_mm, dot(point_mm, sides.normal), end), reach_mm);
    };
    add_end(from, 0);
    add_end(to, 1);
    return touches;
}

struct Closest {
    Vec2 reference_mm;
    Vec2 incident_mm;
    float distance_mm2 = std::numeric_limits<float>::max();
};

/// The two ends that are closest to each other.
Closest closest_ends(Line const& reference, Line const& incident) {
    Closest closest;
    for (Vec2 const r : {reference.from_mm, reference.to_mm}) {
        for (Vec2 const i : {incident.from_mm, incident.to_mm}) {
            float const distance_mm2 = squared_length(i - r);
            if (distance_mm2 < closest.distance_mm2) {
                closest = {r, i, distance_mm2};
            }
        }
    }
    return closest;
}

/// The touch of two corners; none if an end of one side is closer to the middle of the other one, or above its end.
std::optional<Manifold> of_corners(Sides sides, float reach_mm) {
    Closest const closest = closest_ends(sides.reference, sides.incident);
    constexpr float kRounding = 1.0F - 1e-5F;
    float const to_sides_mm2 = std::min(
        {distance_mm2(sides.reference, sides.incident.from_mm), distance_mm2(sides.reference, sides.incident.to_mm),
         distance_mm2(sides.incident, sides.reference.from_mm), distance_mm2(sides.incident, sides.reference.to_mm)});
    Vec2 const along{-sides.normal.y, sides.normal.x};
    bool const is_above = std::abs(dot(closest.incident_mm - closest.reference_mm, along)) < kSamePlaceMm;
    if (is_above || to_sides_mm2 < kRounding * closest.distance_mm2) {
        return std::nullopt;
    }
    float const distance_mm = std::sqrt(closest.distance_mm2);
    sides.normal = (1.0F / distance_mm) * (closest.incident_mm - closest.reference_mm);
    Manifold touches{.normal = sides.normal};
    add(touches, touch_at(sides, closest.incident_mm, distance_mm, 0), reach_mm);
    return touches;
}

/// `is_apart`: the polygons do not overlap.
Manifold touches_between(Sides const& sides, bool is_apart, float reach_mm) {
    if (is_apart) {
        if (std::optional<Manifold> const corners = of_corners(sides, reach_mm)) {
            return *corners;
        }
    }
    if (std::optional<Manifold> const faces = clipped(sides, reach_mm)) {
        return *faces;
    }
    return {};
}

/// The directions that a corner of a wall pushes to lie between the normals of its two edges.
bool pushes_from_corner(WallSide const& side, Vec2 normal) {
    return side.has_corner && dot(normal, side.along) <= 0.0F && dot(normal, side.along_previous) >= 0.0F;
}

/// How far an edge of a wall is out of the side of a hull that it is furthest from. The wall goes on behind an end that
/// is no convex corner.
float separation_mm(Hull const& hull, WallSide const& side) {
    Vec2 const to_mm = side.from_mm + side.length_mm * side.along;
    float furthest_mm = -std::numeric_limits<float>::max();
    for (std::uint32_t k = 0; k < hull.count; ++k) {
        float const slope = dot(side.along, hull.outwards[k]);
        bool const goes_on = slope > 0.0F ? !side.has_corner : !side.ends_in_corner;
        if (slope == 0.0F || !goes_on) {
            Vec2 const nearest_mm = slope > 0.0F ? side.from_mm : to_mm;
            furthest_mm = std::max(furthest_mm, dot(nearest_mm - hull.corner_mm[k], hull.outwards[k]));
        }
    }
    return furthest_mm;
}

/// The touch of a wall's corner with the inside of a hull's side or with one of its corners.
Manifold touches_with_corner(Hull const& hull, WallSide const& side, float reach_mm) {
    Hull corner;
    corner.count = 1;
    corner.corner_mm[0] = side.from_mm;
    Manifold const touches = touches_of(hull, corner, reach_mm);
    return pushes_from_corner(side, touches.normal) ? touches : Manifold{};
}

}  // namespace

Manifold touches_of(Hull const& a, Hull const& b, float reach_mm) {
    assert(a.count > 1 || b.count > 1);
    Furthest const from_a = furthest_from_side(a, b);
    Furthest const from_b = furthest_from_side(b, a);
    bool const is_of_a = from_a.distance_mm + kPreferenceMm >= from_b.distance_mm;
    Furthest const& furthest = is_of_a ? from_a : from_b;
    if (furthest.distance_mm >= reach_mm + a.radius_mm + b.radius_mm) {
        return {};
    }
    Hull const& reference = is_of_a ? a : b;
    Hull const& incident = is_of_a ? b : a;
    Vec2 const normal = reference.outwards[furthest.side];
    std::uint32_t const against = side_against(incident, normal);
    Sides const sides{.reference = side_of(reference, furthest.side),
                      .incident = side_of(incident, against),
                      .normal = normal,
                      .reference_radius_mm = reference.radius_mm,
                      .incident_radius_mm = incident.radius_mm,
                      .features = (is_of_a ? 1U : 0U) | furthest.side << 1U | against << 4U};
    Manifold touches = touches_between(sides, furthest.distance_mm > 0.0F, reach_mm);
    if (is_of_a) {
        touches.normal = -touches.normal;
    }
    return touches;
}

Manifold touches_with(Hull const& hull, WallSide const& side, float reach_mm) {
    Vec2 const to_mm = side.from_mm + side.length_mm * side.along;
    float const above_edge_mm = lowest_mm(hull, side.from_mm, side.normal);
    // Where a side of the hull separates them better than the edge, the hull is in front of an end of the edge, or
    // beside it: it may reach far behind the line of a short edge without touching it.
    bool const is_beside = separation_mm(hull, side) > above_edge_mm + kPreferenceMm;
    bool const is_behind = dot(hull.centre_mm - side.from_mm, side.normal) < 0.0F;
    if (!is_beside && !is_behind && above_edge_mm < reach_mm + hull.radius_mm) {
        std::uint32_t const against = side_against(hull, side.normal);
        // Free space is on the right of an edge, and on the left of a hull's side.
        Sides const sides{.reference = {to_mm, side.from_mm},
                          .incident = side_of(hull, against),
                          .normal = side.normal,
                          .reference_radius_mm = 0.0F,
                          .incident_radius_mm = hull.radius_mm,
                          .features = against};
        if (std::optional<Manifold> const faces = clipped(sides, reach_mm)) {
            return *faces;
        }
    }
    return side.has_corner ? touches_with_corner(hull, side, reach_mm) : Manifold{};
}

}  // namespace pogosim
