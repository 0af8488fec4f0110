#include "sim/make_ring.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pogosim {

namespace {

// The bodies' centres are this much of the bounding radius inside of the shape's outline at most.
constexpr float kMostInset = 0.3F;
// Stiffness of the springs across, in parts of that between neighbours.
constexpr float kCrossOfDisks = 0.8F;
constexpr float kCrossOfSegments = 0.4F;
// A membrane of cloth, not of rubber: neighbours are never further apart than this part more than at rest.
constexpr float kMaxStretch = 0.05F;

/// The shape on whose outline the bodies' centres lie.
Shape line_of_centres(ObjectSpec const& spec) {
    return inset(spec.shape, std::min(half_thickness_mm(*spec.ring), kMostInset * bounding_radius(spec.shape)));
}

RingBody segment_between(Vec2 from, Vec2 to, float thickness_mm) {
    Vec2 const along = to - from;
    return {.position_mm = 0.5F * (from + to),
            .heading_rad = std::atan2(along.y, along.x),
            .shape = {.kind = ShapeKind::rectangle, .width_mm = length(along), .height_mm = thickness_mm}};
}

Joint spring(RingParts const& ring, std::size_t a, std::size_t b, float stiffness_hz, float damping_ratio) {
    return {.a = static_cast<std::uint32_t>(a),
            .b = static_cast<std::uint32_t>(b),
            .anchor_a_mm = {},
            .anchor_b_mm = {},
            .length_mm = length(ring.bodies[b].position_mm - ring.bodies[a].position_mm),
            .stiffness_hz = stiffness_hz,
            .damping_ratio = damping_ratio};
}

/// At the end of segment a and the start of segment b.
Joint hinge(RingParts const& ring, std::size_t a, std::size_t b) {
    return {.a = static_cast<std::uint32_t>(a),
            .b = static_cast<std::uint32_t>(b),
            .anchor_a_mm = {0.5F * ring.bodies[a].shape.width_mm, 0.0F},
            .anchor_b_mm = {-0.5F * ring.bodies[b].shape.width_mm, 0.0F}};
}

}  // namespace

float outer_radius_mm(ObjectSpec const& spec) {
    float const radius_mm = bounding_radius(spec.shape);
    return spec.ring ? std::max(radius_mm, bounding_radius(line_of_centres(spec)) + half_thickness_mm(*spec.ring))
                     : radius_mm;
}

float half_thickness_mm(RingSpec const& ring) {
    return ring.segments ? 0.5F * ring.thickness_mm.value_or(ring.radius_mm) : ring.radius_mm;
}

Polygon ring_line(ObjectSpec const& spec, Placement const& placement) {
    Polygon const line = outline(line_of_centres(spec), spec.ring->body_count);
    return moved(spread_along(line, spec.ring->body_count), placement.position_mm, placement.heading_rad);
}

RingParts make_ring(ObjectSpec const& spec, Placement const& placement) {
    RingSpec const& shape = *spec.ring;
    Polygon const corners = ring_line(spec, placement);
    std::size_t const count = corners.size();
    RingParts ring;
    for (std::size_t i = 0; i < count; ++i) {
        ring.bodies.push_back(
            shape.segments ? segment_between(corners[i], corners[(i + 1) % count], 2.0F * half_thickness_mm(shape))
                           : RingBody{.position_mm = corners[i],
                                      .shape = {.kind = ShapeKind::disk, .radius_mm = shape.radius_mm}});
    }
    float const damping_ratio = spec.body->linear_damping;
    for (std::size_t i = 0; i < count; ++i) {
        std::size_t const next = (i + 1) % count;
        if (shape.segments) {
            ring.joints.push_back(hinge(ring, i, next));
        } else {
            ring.joints.push_back(spring(ring, i, next, shape.stiffness_hz, damping_ratio));
            ring.joints.back().max_stretch = kMaxStretch;
        }
        auto const span = static_cast<std::size_t>(shape.cross_span);
        if (span > 1 && span + 1 < count) {
            float const share = shape.segments ? kCrossOfSegments : kCrossOfDisks;
            ring.joints.push_back(spring(ring, i, (i + span) % count, share * shape.stiffness_hz, damping_ratio));
        }
    }
    return ring;
}

float widest_gap_mm(RingParts const& ring) {
    float widest = 0.0F;
    for (Joint const& joint : ring.joints) {
        if (joint.max_stretch > 0.0F) {
            float const most_mm = (1.0F + joint.max_stretch) * joint.length_mm;
            widest = std::max(widest, most_mm - bounding_radius(ring.bodies[joint.a].shape) -
                                          bounding_radius(ring.bodies[joint.b].shape));
        }
    }
    return widest;
}

}  // namespace pogosim
