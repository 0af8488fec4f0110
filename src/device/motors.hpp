// The motors of a robot. `device`: its index into World::devices; `motor`: 0 right, 1 left, 2 back.
#pragma once

#include <cstddef>
#include <cstdint>

#include "world/world.hpp"

namespace pogosim {

inline constexpr std::uint16_t kFullMotorPower = 1023;

/// Powers above kFullMotorPower count as that.
void set_motor_power(World& world, std::size_t device, int motor, std::uint16_t power);

/// 0 or 1; others count as 1. Forward is 0 on the right and 1 on the left.
void set_motor_direction(World& world, std::size_t device, int motor, std::uint8_t direction);

/// Bit m: the direction of motor m.
std::uint32_t motor_directions(World const& world, std::size_t device);

/// At the end of each tick: a robot with wheels whose motors were ever set gets the velocity that they ask for, with
/// fresh noise.
void drive(World& world, std::uint32_t robot);

}  // namespace pogosim
