// Where a picture draws the ends of an infrared link between two rigid bodies.
#pragma once

#include "geometry/shape.hpp"
#include "render/snapshot.hpp"

namespace pogosim {

/// A rigid body at an end of a link.
struct LinkedBody {
    Shape const& shape;
    float radius_mm = 0.0F;    // of the bounding disk
    float heading_rad = 0.0F;  // not finite: unknown, and the bounding disk stands for the body
};

/// Puts the ends on the borders of two bodies, towards each other, or at points between the two where they touch or
/// overlap. `centre_mm` is that of the first body, and `span_mm` leads from there to the centre of the second.
void place_ends(InfraredLink& link, Vec2 centre_mm, LinkedBody const& from, Vec2 span_mm, LinkedBody const& to);

}  // namespace pogosim
