// The motors of a robot. `device`: its index into World::devices; `motor`: 0 right, 1 left, 2 back.
#pragma once

#include <cstddef>
#include <cstdint>

#include "world/world.hpp"

namespace pogosim {

inline constexpr std::uint16_t kFullMotorPower = 1023;

/// Powers above kFullMotorPower count as that.
void set_motor_power(World& world, std::size_t device, int motor, std::uint16_t power);

/// 0 or 1; others count as 1. The model of the robot says which of them is forward.
void set_motor_direction(World& world, std::size_t device, int motor, std::uint8_t direction);

/// Bit m: the direction of motor m.
std::uint32_t motor_directions(World const& world, std::size_t device);

/// Sets the velocity command of this robot to what its motors ask for, noise included; called at each control tick.
///
/// With two wheels, and signed powers L and R (PWM, after the direction bits and the robot's bias), along the heading
/// v = max_linear_speed (L + R) / (2 * 1023), clockwise on the screen omega = max_angular_speed (L - R) / 511.5.
void command_velocity(World& world, std::uint32_t robot);

/// At the end of each tick: a robot with motors that were ever set gets the velocity that they ask for, with
/// fresh noise.
inline void drive(World& world, std::uint32_t robot) {
    if (world.devices.motors[robot].driven && world.spec_of(robot).model.has_motors()) {
        command_velocity(world, robot);
    }
}

}  // namespace pogosim
