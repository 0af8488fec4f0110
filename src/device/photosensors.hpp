// What a program reads of the light sensors of its robot.
#pragma once

#include <cstddef>
#include <cstdint>

#include "world/world.hpp"

namespace pogosim {

/// Sensor counts at a photosensor (0 back, 1 front left, 2 front right) of a robot that has a body, with its bias, its
/// noise, which is drawn here, and the bits of its converter.
std::int16_t read_photosensor(World& world, std::uint32_t robot, std::size_t sensor);

}  // namespace pogosim
