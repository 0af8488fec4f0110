// What a program reads of the light sensors of its robot.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "world/world.hpp"

namespace pogosim {

/// Said once to a program that reads a photosensor where no light can be.
inline constexpr std::string_view kNoLamps =
    "there is no lamp in this world, so it is dark everywhere; add an object of type static_light or another lamp to "
    "the configuration";

/// Sensor counts at a photosensor (0 back, 1 front left, 2 front right) of a robot that has a body, with its bias, its
/// noise, which is drawn here, and the bits of its converter.
std::int16_t read_photosensor(World& world, std::uint32_t robot, std::size_t sensor);

}  // namespace pogosim
