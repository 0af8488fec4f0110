// Shapes of objects, in the object's own frame (heading along +x).
#pragma once

#include <string_view>

#include "geometry/polygon.hpp"

namespace pogosim {

enum class ShapeKind { disk, rectangle, triangle, global, arena };

/// What the `geometry` key and its companions say. Only the sizes of the named kind count.
struct Shape {
    ShapeKind kind = ShapeKind::disk;
    float radius_mm = 10.0F;       // disk
    float width_mm = 10.0F;        // rectangle, along x
    float height_mm = 10.0F;       // rectangle, along y
    float side_length_mm = 10.0F;  // triangle: equilateral, centroid at the origin, one corner towards -y

    friend bool operator==(Shape const&, Shape const&) = default;
};

/// Radius of the smallest disk around the shape's origin that holds it, mm: the "radius" of an object for IR range,
/// occlusion, sensors and drawing. 0 for global and arena.
float bounding_radius(Shape const& shape);

/// Radius of the largest disk around the shape's origin that it holds, mm. 0 for global and arena.
float inner_radius(Shape const& shape);

/// Corners of the shape around its origin, clockwise on the screen; a disk has `disk_corners` of them, the first at +x.
/// Empty for global and arena.
Polygon outline(Shape const& shape, int disk_corners = 128);

/// The same shape with every side moved inwards by so much, mm (outwards when negative). Sizes do not fall below 0.
Shape inset(Shape const& shape, float inwards_mm);

/// Smallest box around the shape, relative to its origin. Empty, at the origin, for global and arena.
Box bounding_box(Shape const& shape);

/// True for shapes that are the same wherever they are put: global and arena.
inline bool is_everywhere(Shape const& shape) {
    return shape.kind == ShapeKind::global || shape.kind == ShapeKind::arena;
}

/// True when the point, given relative to the shape's origin, is inside. Global holds every point; arena is the
/// caller's to decide and counts as everywhere here.
bool contains(Shape const& shape, Vec2 offset_mm);

}  // namespace pogosim
