// Keys that several types of lamps share.
#pragma once

#include <numbers>
#include <span>

#include "config/key.hpp"
#include "config/map_reader.hpp"
#include "world/specs.hpp"

namespace pogosim {

inline constexpr Range kLightLevel = between(0, 32767);
inline constexpr Range kSeconds = between(0, 1e9);
inline constexpr Range kStartTime = between(-1e9, 1e9);
inline constexpr Range kHalfWidth = above(0).up_to(std::numbers::pi);
inline constexpr Range kAngle = between(-1e4, 1e4).usually_up_to(6.3);
inline constexpr Range kAngularSpeed = between(-1e4, 1e4).usually_up_to(50);

/// `x` and `y` of a lighthouse.
std::span<Key<Vec2> const> lighthouse_centre_keys();

/// How a spot shines, its photo start, and its `x` and `y`. Its shape has been read before.
void read_spot(MapReader& reader, SpotSpec& spot);

}  // namespace pogosim
