// `geometry` and the sizes that go with it.
#pragma once

#include <span>

#include "config/key.hpp"
#include "config/scenario.hpp"
#include "geometry/shape.hpp"

namespace pogosim {

/// Sizes and coordinates. What is below 1 mm is probably in metres.
inline constexpr Range kLength = above(0).up_to(kMaxLength).usually_from(1);
/// Smallest size of a body: a float cannot divide by the mass of a smaller one.
inline constexpr Range kBodyLength = between(1e-3, kMaxLength).usually_from(1);
inline constexpr Range kLengthOrZero = between(0, kMaxLength).usually_from(1);
inline constexpr Range kCoordinate = between(-kMaxLength, kMaxLength).usually_from(1);

/// `geometry` of things with a body: disk, rectangle, triangle.
std::span<Key<Shape> const> solid_geometry_keys();
/// The same for robots, which are disks unless it says otherwise.
std::span<Key<Shape> const> robot_geometry_keys();
/// Geometries of walls: those of bodies, or arena.
std::span<Key<Shape> const> outline_geometry_keys();
/// Geometries of lamps: those of bodies, arena, or global.
std::span<Key<Shape> const> any_geometry_keys();

/// The sizes of all shapes.
std::span<Key<Shape> const> size_keys();

}  // namespace pogosim
