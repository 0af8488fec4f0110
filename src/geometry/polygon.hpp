// Closed polygons and what one asks of them. A polygon is its list of corners; the last joins the first.
#pragma once

#include <span>
#include <vector>

#include "base/vec2.hpp"

namespace pogosim {

using Polygon = std::vector<Vec2>;

/// Area with the sign of the winding: positive when the corners run clockwise on the screen (y down).
double signed_area(std::span<Vec2 const> polygon);

/// Centre of mass of the enclosed surface. The polygon must enclose some.
Vec2 centroid(std::span<Vec2 const> polygon);

/// True when the point is inside (even-odd rule).
bool contains(std::span<Vec2 const> polygon, Vec2 point);

/// True when the ray from the point towards +x crosses the edge from `a` to `b`; of its two ends an edge owns the one
/// of smaller y. A point is inside when an odd number of edges is crossed.
bool ray_crosses(Vec2 a, Vec2 b, Vec2 point);

/// Point of the segment from `a` to `b` that is nearest to `point`.
Vec2 nearest_on_segment(Vec2 a, Vec2 b, Vec2 point);

/// Distance from the point to the nearest edge, in the polygon's unit. The polygon needs at least one corner.
float distance_to_outline(std::span<Vec2 const> polygon, Vec2 point);

/// `count` points on the outline, evenly spaced along it, from its first corner on. The polygon has a positive length.
std::vector<Vec2> spread_along(std::span<Vec2 const> polygon, int count);

/// The polygon turned by `heading_rad` around the origin, then moved by `offset`.
Polygon moved(std::span<Vec2 const> polygon, Vec2 offset, float heading_rad);

/// Smallest axis-aligned box around all corners.
Box bounding_box(std::span<Vec2 const> polygon);

}  // namespace pogosim
