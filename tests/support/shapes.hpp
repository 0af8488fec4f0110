// Shapes of bodies, in short.
#pragma once

#include "geometry/shape.hpp"

namespace pogosim::testing {

inline Shape disk(float radius_mm) {
    return {.kind = ShapeKind::disk, .radius_mm = radius_mm};
}

inline Shape rectangle(float width_mm, float height_mm) {
    return {.kind = ShapeKind::rectangle, .width_mm = width_mm, .height_mm = height_mm};
}

inline Shape triangle(float side_mm) {
    return {.kind = ShapeKind::triangle, .side_length_mm = side_mm};
}

}  // namespace pogosim::testing
