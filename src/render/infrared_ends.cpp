#include "render/infrared_ends.hpp"

#include <algorithm>
#include <cmath>

namespace pogosim {

namespace {

/// From the centre to the border, along `offset`.
float reach_of(LinkedBody const& body, Vec2 offset) {
    float const distance = length(offset);
    if (body.shape.kind == ShapeKind::disk || !std::isfinite(body.heading_rad) || distance <= 0.0F) {
        return body.radius_mm;
    }
    return reach(body.shape, rotate((1.0F / distance) * offset, direction(-body.heading_rad)));
}

}  // namespace

void place_ends(InfraredLink& link, Vec2 centre_mm, LinkedBody const& from, Vec2 span_mm, LinkedBody const& to) {
    float const from_reach_mm = reach_of(from, span_mm);
    float const to_reach_mm = reach_of(to, -span_mm);
    float const distance = std::max(length(span_mm), from_reach_mm + to_reach_mm);
    if (distance <= 0.0F) {  // a compound may have nothing in that direction: both can be 0
        link.from_mm = link.to_mm = centre_mm;
        return;
    }
    link.from_mm = centre_mm + (from_reach_mm / distance) * span_mm;
    link.to_mm = centre_mm + (1.0F - to_reach_mm / distance) * span_mm;
}

}  // namespace pogosim
