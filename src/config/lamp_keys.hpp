// Keys that several types of lamps share.
#pragma once

#include <numbers>
#include <span>

#include "config/key.hpp"
#include "config/map_reader.hpp"
#include "config/scenario.hpp"
#include "world/specs.hpp"

namespace pogosim {

inline constexpr Range kLightLevel = between(0, 32767);
inline constexpr Range kSeconds = between(0, 1e9);
inline constexpr Range kStartTime = between(-1e9, 1e9);
inline constexpr Range kHalfWidth = above(0).up_to(std::numbers::pi);
inline constexpr Range kAngle = between(-1e4, 1e4).usually_up_to(6.3);
inline constexpr Range kAngularSpeed = between(-1e4, 1e4).usually_up_to(50);

/// The shape that a lighthouse can light, and where it stands.
void read_lighthouse_place(MapReader& reader, Shape& shape, Vec2& centre_mm);

/// Makes the object this lamp, whose own keys have been read, and reads those that all lamps have. Light without a
/// place, such as the same level everywhere, casts no shadows.
void make_lamp_object(MapReader& reader, ObjectConfig& object, LampSpec lamp, bool has_place);

/// Warns when only one of two coordinates is given: the other one has its default. (For bodies it is an error; lamps
/// have always taken 0.)
void warn_of_lone_coordinate(MapReader const& reader, std::string_view x, std::string_view y, Vec2 centre_mm);

}  // namespace pogosim
