// `geometry` and the sizes that go with it.
#pragma once

#include <span>

#include "config/key.hpp"
#include "geometry/shape.hpp"

namespace pogosim {

/// Largest length and coordinate, mm. A float still tells 0.06 mm apart there.
inline constexpr double kMaxLength = 1.0e6;

/// `geometry` of things with a body: disk, rectangle, triangle.
std::span<Key<Shape> const> solid_geometry_keys();
/// Of walls: those, or arena.
std::span<Key<Shape> const> outline_geometry_keys();
/// Of lamps: those, arena, or global.
std::span<Key<Shape> const> any_geometry_keys();

/// The sizes of all shapes.
std::span<Key<Shape> const> size_keys();

}  // namespace pogosim
