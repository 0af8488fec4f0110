// The mouse over the picture: a click selects, a drag moves an object or the view.
#pragma once

#include <cstdint>
#include <optional>

#include "base/vec2.hpp"

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

}  // namespace pogosim
