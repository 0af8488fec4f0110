// Shapes of bodies, in short.
#pragma once

#include <cmath>
#include <vector>

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

inline Shape capsule(float width_mm, float height_mm) {
    return {.kind = ShapeKind::capsule, .width_mm = width_mm, .height_mm = height_mm};
}

/// Corners clockwise on the screen.
inline Shape polygon(Polygon const& corners_mm, float corner_radius_mm = 0.0F) {
    Shape shape{.kind = ShapeKind::polygon};
    shape.corners_mm = corners_mm;
    shape.corner_radius_mm = corner_radius_mm;
    return centred(shape);
}

inline Shape rounded(Shape shape, float corner_radius_mm) {
    shape.corner_radius_mm = corner_radius_mm;
    return shape;
}

/// A regular octagon.
inline Shape octagon(float across_sides_mm) {
    Polygon corners_mm;
    for (int i = 0; i < 8; ++i) {
        float const turn_rad = (static_cast<float>(i) + 0.5F) * 0.25F * 3.14159265F;
        corners_mm.push_back(0.5F * across_sides_mm / std::cos(0.125F * 3.14159265F) *
                             Vec2{std::cos(turn_rad), std::sin(turn_rad)});
    }
    return polygon(corners_mm);
}

/// Boxes that are put together, each with its corner of least coordinates and its size.
struct BoxPart {
    Vec2 from_mm;
    Vec2 size_mm;
};
inline Shape compound(std::vector<BoxPart> const& boxes) {
    Shape shape{.kind = ShapeKind::compound};
    for (auto const& [from, size] : boxes) {
        shape.parts.push_back({{from, from + Vec2{size.x, 0.0F}, from + size, from + Vec2{0.0F, size.y}}, 0.0F});
    }
    return centred(shape);
}

/// A tray that is open ahead: a wall behind, and one on either side.
inline Shape tray(float length_mm, float width_mm, float wall_mm) {
    return compound({{{0.0F, 0.0F}, {wall_mm, width_mm}},
                     {{wall_mm, 0.0F}, {length_mm - wall_mm, wall_mm}},
                     {{wall_mm, width_mm - wall_mm}, {length_mm - wall_mm, wall_mm}}});
}

}  // namespace pogosim::testing
