// The LEDs of a robot.
#pragma once

#include <cstddef>
#include <cstdint>

#include "world/world.hpp"

namespace pogosim {

/// 0 head, 1 front, 2 right, 3 back, 4 left.
inline void set_led(World& world, std::uint32_t robot, std::size_t led, Rgb colour) {
    world.robots.led[robot][led] = colour;
}

}  // namespace pogosim
