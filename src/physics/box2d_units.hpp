// Box2D counts in units of 100 mm. Only files of this room include it.
#pragma once

#include <box2d/box2d.h>

#include "base/vec2.hpp"

namespace pogosim {

inline constexpr float kMmPerUnit = 100.0F;

inline b2Vec2 to_box2d(Vec2 mm) {
    return {mm.x / kMmPerUnit, mm.y / kMmPerUnit};
}
inline Vec2 from_box2d(b2Vec2 units) {
    return {units.x * kMmPerUnit, units.y * kMmPerUnit};
}

}  // namespace pogosim
