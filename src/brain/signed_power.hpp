// Motor powers with a sign, as brains without a program have them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "device/motors.hpp"

namespace pogosim {

/// Direction bit with which a motor of this robot turns forwards.
inline std::uint8_t forward_direction(World const& world, std::uint32_t robot, std::size_t motor) {
    std::vector<Drive> const& drives = world.spec_of(robot).model.drives;
    auto const drive = std::ranges::find(drives, motor, &Drive::motor);
    return drive != drives.end() ? drive->forward : Motors{}.direction[motor];
}

/// -1023 to 1023, beyond which powers are cut; positive is forward.
inline void set_signed_power(World& world, std::uint32_t robot, std::size_t motor, std::int32_t power) {
    std::int32_t const most = kFullMotorPower;
    std::uint8_t const forward = forward_direction(world, robot, motor);
    std::uint8_t const backward = forward == 0 ? 1 : 0;
    int const id = static_cast<int>(motor);
    set_motor_power(world, robot, id, static_cast<std::uint16_t>(std::abs(std::clamp(power, -most, most))));
    set_motor_direction(world, robot, id, power < 0 ? backward : forward);
}

}  // namespace pogosim
