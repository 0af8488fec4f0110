// Bodies that were put on top of each other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec2.hpp"

namespace pogosim {

/// An engine does not know where to push bodies with the same centre; those that are so far apart separate.
inline constexpr float kApartMm = 0.01F;

/// Moves apart centres that coincide: those of the `moved` bodies (indices into `position_mm`, ascending) go by
/// multiples of kApartMm to +x from the others and from each other.
void part_coinciding_centres(std::vector<Vec2>& position_mm, std::span<std::uint32_t const> moved);

}  // namespace pogosim
