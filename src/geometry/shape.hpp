// Shapes of objects, in the object's own frame (heading along +x).
#pragma once

#include <vector>

#include "geometry/polygon.hpp"
#include "geometry/rounded_polygon.hpp"

namespace pogosim {

enum class ShapeKind { disk, rectangle, capsule, triangle, polygon, compound, global, arena };

/// What the `geometry` key and its companions say. Only the sizes of the named kind count.
struct Shape {
    ShapeKind kind = ShapeKind::disk;
    float radius_mm = 10.0F;              // disk
    float width_mm = 10.0F;               // rectangle and capsule, along x
    float height_mm = 10.0F;              // rectangle and capsule, along y
    float side_length_mm = 10.0F;         // triangle: equilateral, centroid at the origin, one corner towards -y
    float corner_radius_mm = 0.0F;        // rectangle, triangle, polygon: rounding within the sharp corners
    Polygon corners_mm{};                 // polygon: the sharp corners, convex, clockwise on the screen
    std::vector<RoundedPolygon> parts{};  // compound

    friend bool operator==(Shape const&, Shape const&) = default;
};

/// The same polygon or compound, moved so that its centre of mass is the origin. Parts of a compound that overlap count
/// twice where they do. Other shapes have it there.
Shape centred(Shape const& shape);

/// What a body of this shape consists of. Empty for global and arena.
std::vector<RoundedPolygon> convex_parts(Shape const& shape);

/// Those of all parts together.
AreaMoments moments_of(Shape const& shape);

/// The largest `corner_radius_mm` that the shape can have, mm: every side keeps some of its length.
float largest_corner_radius(Shape const& shape);

/// True for shapes with corners that can be rounded.
inline bool has_corners(Shape const& shape) {
    return shape.kind == ShapeKind::rectangle || shape.kind == ShapeKind::triangle || shape.kind == ShapeKind::polygon;
}

/// Radius of the smallest disk around the shape's origin that holds it, mm: the "radius" of an object for IR range,
/// occlusion, sensors and drawing. 0 for global and arena.
float bounding_radius(Shape const& shape);

/// Radius of the largest disk around the shape's origin that it holds, mm; of a compound, that of its slimmest part. 0
/// for global and arena.
float inner_radius(Shape const& shape);

/// Corners of the shape around its origin, clockwise on the screen; a disk has `disk_corners` of them, the first at +x.
/// Empty for global and arena. The shape is no compound.
Polygon outline(Shape const& shape, int disk_corners = 128);

/// The same of each part of a compound; of other shapes, the outline if they have one.
std::vector<Polygon> outlines(Shape const& shape, int disk_corners = 128);

/// Distance from the shape's origin to its border in a direction (a unit vector), mm: to where one leaves it for the
/// last time; 0 if a compound has nothing in that direction. The shape is not global or arena.
float reach(Shape const& shape, Vec2 towards);

/// The same shape with every side moved inwards by so much, mm (outwards when negative). Sizes do not fall below 0. A
/// compound only grows.
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
