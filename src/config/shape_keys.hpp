// `geometry` and the sizes that go with it.
#pragma once

#include <span>

#include "config/key.hpp"
#include "config/map_reader.hpp"
#include "config/scenario.hpp"
#include "geometry/shape.hpp"

namespace pogosim {

/// Sizes and coordinates. What is below 1 mm is probably in metres.
inline constexpr Range kLength = above(0).up_to(kMaxLength).usually_from(1);
/// Smallest size of a body: a float cannot divide by the mass of a smaller one.
inline constexpr Range kBodyLength = between(1e-3, kMaxLength).usually_from(1);
inline constexpr Range kLengthOrZero = between(0, kMaxLength).usually_from(1);
inline constexpr Range kDegrees = between(-360, 360);

/// Notes angles of a map that are probably in radians: nearly all of those have a fraction, few angles in degrees do.
void look_for_radians(MapReader const& reader, UnitSlips& slips);

inline constexpr Range kCoordinate = between(-kMaxLength, kMaxLength).usually_from(1);

/// `geometry` of things with a rigid body.
std::span<Key<Shape> const> solid_geometry_keys();
/// The same for robots, which are disks unless it says otherwise.
std::span<Key<Shape> const> robot_geometry_keys();
/// Geometries of membranes: what has one outline.
std::span<Key<Shape> const> ring_geometry_keys();
/// Geometries of walls: what has one outline, or arena.
std::span<Key<Shape> const> outline_geometry_keys();
/// Geometries of lamps: what has one outline, arena, or global.
std::span<Key<Shape> const> any_geometry_keys();

/// `geometry`, which takes the names of the given table, and what goes with it.
void read_shape(MapReader& reader, std::span<Key<Shape> const> geometry_keys, Shape& shape);

/// The same, which can be a compound.
void read_solid_shape(MapReader& reader, std::span<Key<Shape> const> geometry_keys, Shape& shape);

/// The keys of a part of a compound.
std::vector<KeyDescription> shape_part_keys();

}  // namespace pogosim
