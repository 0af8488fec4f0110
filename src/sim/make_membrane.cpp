#include "sim/make_membrane.hpp"

#include <algorithm>
#include <cstdint>

#include "base/exact_math.hpp"

namespace pogosim {

namespace {

// At most this share of the bounding radius lies between the bodies' centres and the shape's outline.
constexpr float kMostInset = 0.3F;
// Stiffness of the springs across, in parts of that between neighbours.
constexpr float kCrossOfDisks = 0.8F;
constexpr float kCrossOfSegments = 0.4F;
// Membranes are of cloth, not of rubber: the distance of neighbours never exceeds that at rest by more than this share.
constexpr float kMaxStretch = 0.05F;

/// The shape on whose outline the bodies' centres lie.
Shape line_of_centres(ObjectSpec const& spec) {
    return inset(spec.shape, std::min(half_thickness_mm(*spec.membrane), kMostInset * bounding_radius(spec.shape)));
}

MembraneBody segment_between(Vec2 from, Vec2 to, float thickness_mm) {
    Vec2 const along = to - from;
    return {.position_mm = 0.5F * (from + to),
            .heading_rad = static_cast<float>(exact::atan2(static_cast<double>(along.y), static_cast<double>(along.x))),
            .shape = {.kind = ShapeKind::rectangle, .width_mm = length(along), .height_mm = thickness_mm}};
}

Joint spring(MembraneParts const& membrane, std::size_t a, std::size_t b, float stiffness_hz, float damping_ratio) {
    return {.a = static_cast<std::uint32_t>(a),
            .b = static_cast<std::uint32_t>(b),
            .anchor_a_mm = {},
            .anchor_b_mm = {},
            .length_mm = length(membrane.bodies[b].position_mm - membrane.bodies[a].position_mm),
            .stiffness_hz = stiffness_hz,
            .damping_ratio = damping_ratio};
}

/// At the end of segment a and the start of segment b.
Joint hinge(MembraneParts const& membrane, std::size_t a, std::size_t b) {
    return {.a = static_cast<std::uint32_t>(a),
            .b = static_cast<std::uint32_t>(b),
            .anchor_a_mm = {0.5F * membrane.bodies[a].shape.width_mm, 0.0F},
            .anchor_b_mm = {-0.5F * membrane.bodies[b].shape.width_mm, 0.0F}};
}

}  // namespace

float outer_radius_mm(ObjectSpec const& spec) {
    float const radius_mm = bounding_radius(spec.shape);
    return spec.membrane
               ? std::max(radius_mm, bounding_radius(line_of_centres(spec)) + half_thickness_mm(*spec.membrane))
               : radius_mm;
}

float half_thickness_mm(MembraneSpec const& membrane) {
    return membrane.segments ? 0.5F * membrane.thickness_mm.value_or(membrane.radius_mm) : membrane.radius_mm;
}

Polygon membrane_line(ObjectSpec const& spec, Placement const& placement) {
    Polygon const line = outline(line_of_centres(spec), spec.membrane->body_count);
    return moved(spread_along(line, spec.membrane->body_count), placement.position_mm, placement.heading_rad);
}

MembraneParts make_membrane(ObjectSpec const& spec, Placement const& placement) {
    MembraneSpec const& shape = *spec.membrane;
    Polygon const corners = membrane_line(spec, placement);
    std::size_t const count = corners.size();
    MembraneParts membrane;
    for (std::size_t i = 0; i < count; ++i) {
        membrane.bodies.push_back(
            shape.segments ? segment_between(corners[i], corners[(i + 1) % count], 2.0F * half_thickness_mm(shape))
                           : MembraneBody{.position_mm = corners[i],
                                          .shape = {.kind = ShapeKind::disk, .radius_mm = shape.radius_mm}});
    }
    float const damping_ratio = spec.body->linear_damping;
    for (std::size_t i = 0; i < count; ++i) {
        std::size_t const next = (i + 1) % count;
        if (shape.segments) {
            membrane.joints.push_back(hinge(membrane, i, next));
        } else {
            membrane.joints.push_back(spring(membrane, i, next, shape.stiffness_hz, damping_ratio));
            membrane.joints.back().max_stretch = kMaxStretch;
        }
        auto const span = static_cast<std::size_t>(shape.cross_span);
        if (span > 1 && span + 1 < count) {
            float const share = shape.segments ? kCrossOfSegments : kCrossOfDisks;
            membrane.joints.push_back(
                spring(membrane, i, (i + span) % count, share * shape.stiffness_hz, damping_ratio));
        }
    }
    return membrane;
}

float widest_gap_mm(MembraneParts const& membrane) {
    float widest = 0.0F;
    for (Joint const& joint : membrane.joints) {
        if (joint.max_stretch > 0.0F) {
            float const most_mm = (1.0F + joint.max_stretch) * joint.length_mm;
            widest = std::max(widest, most_mm - bounding_radius(membrane.bodies[joint.a].shape) -
                                          bounding_radius(membrane.bodies[joint.b].shape));
        }
    }
    return widest;
}

}  // namespace pogosim
