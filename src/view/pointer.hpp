// The mouse over the picture: what lies under it; a click selects, a drag moves an object or the view.
#pragma once

#include <cstdint>
#include <optional>

#include "base/vec2.hpp"
#include "render/snapshot.hpp"

namespace pogosim {

/// One button held down.
struct Press {
    Vec2 start_px;
    bool is_drag = false;                   // it has moved further than a hand trembles
    std::optional<std::uint32_t> object{};  // index into Scenery::objects
    Vec2 grip_mm;                           // from the mouse to the object's place
};

struct Pointer {
    std::optional<Press> left;
    std::optional<Vec2> panned_from_px;  // right or middle button
};

/// A press becomes a drag when the mouse moves further than this.
inline constexpr float kTremblePx = 4.0F;

/// The robot with a body that is nearest to the point, if the point is within its radius plus `margin_mm`. A membrane
/// counts through its nearest part.
std::optional<std::uint32_t> robot_at(Snapshot const& snapshot, Vec2 point_mm, float margin_mm);

/// The object that can be dragged and covers the point: the index into Scenery::objects. The one with the nearest
/// centre of several.
std::optional<std::uint32_t> object_at(Snapshot const& snapshot, Vec2 point_mm, float margin_mm);

/// The mean position of an object's bodies, of which it has at least one.
Vec2 centre_of(Snapshot const& snapshot, Object const& object);

}  // namespace pogosim
