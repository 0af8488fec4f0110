// How far two convex parts are apart.
#pragma once

#include "geometry/rounded_polygon.hpp"

namespace pogosim {

/// The shortest distance between two convex parts, mm; 0 where they overlap.
float gap_between(RoundedPolygon const& a, RoundedPolygon const& b);

}  // namespace pogosim
