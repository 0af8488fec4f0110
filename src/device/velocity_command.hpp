// From motor powers to the velocity of a robot.
#pragma once

#include <cstdint>

#include "world/world.hpp"

namespace pogosim {

/// Sets the velocity command of this robot to what its motors ask for, noise included; called at each control tick.
///
/// With two wheels, and signed powers L and R (PWM, after the direction bits and the robot's bias), along the heading
/// v = max_linear_speed (L + R) / (2 * 1023), clockwise on the screen omega = max_angular_speed (L - R) / 511.5.
void command_velocity(World& world, std::uint32_t robot);

}  // namespace pogosim
