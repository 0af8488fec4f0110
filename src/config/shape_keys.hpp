// `geometry` and the sizes that go with it.
#pragma once

#include <span>

#include "config/key.hpp"
#include "geometry/shape.hpp"

namespace pogosim {

/// Largest length and coordinate, mm. A float still tells 0.06 mm apart there.
inline constexpr double kMaxLength = 1.0e6;

/// `geometry` of objects that are disks.
std::span<Key<Shape> const> disk_geometry_keys();
/// `radius`.
std::span<Key<Shape> const> disk_size_keys();

/// `geometry` with every shape, and the sizes of the shapes other than disks.
std::span<Key<Shape> const> any_geometry_keys();
std::span<Key<Shape> const> other_size_keys();

}  // namespace pogosim
