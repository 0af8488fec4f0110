// Finds what lies under the mouse.
#pragma once

#include <cstdint>
#include <optional>

#include "render/snapshot.hpp"

namespace pogosim {

/// The robot with a body that is nearest to the point, if the point is within its radius plus `margin_mm`. A membrane
/// counts through its nearest part.
std::optional<std::uint32_t> robot_at(Snapshot const& snapshot, Vec2 point_mm, float margin_mm);

/// The object that can be dragged and covers the point: the index into Scenery::objects. The one with the nearest
/// centre of several.
std::optional<std::uint32_t> object_at(Snapshot const& snapshot, Vec2 point_mm, float margin_mm);

/// The mean position of an object's bodies, of which it has at least one.
Vec2 centre_of(Snapshot const& snapshot, Object const& object);

}  // namespace pogosim
