// The devices of all robots at the start of a run.
#pragma once

#include <cstdint>

#include "world/world.hpp"

namespace pogosim {

/// Fills World::devices for the robots of the world: biases and clock drift are drawn from each robot's own stream.
void set_up_devices(World& world, std::uint64_t seed);

/// Resets the robot's processor at this time. Cleared: powers, counters of the infrared port, messages that wait, LEDs.
/// Kept, as by the hardware: calibration, flash memory, stored settings of the motors.
void reset_devices(World& world, std::uint32_t robot, std::int64_t now_us);

}  // namespace pogosim
