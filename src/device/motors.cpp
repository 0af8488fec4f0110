#include "device/motors.hpp"

#include <algorithm>

namespace pogosim {

void set_motor_power(World& world, std::size_t device, int motor, std::uint16_t power) {
    Motors& motors = world.devices.motors[device];
    motors.power[static_cast<std::size_t>(motor)] = std::min(power, kFullMotorPower);
    motors.driven = true;
}

void set_motor_direction(World& world, std::size_t device, int motor, std::uint8_t direction) {
    Motors& motors = world.devices.motors[device];
    motors.direction[static_cast<std::size_t>(motor)] = direction != 0 ? 1 : 0;
    motors.driven = true;
}

std::uint32_t motor_directions(World const& world, std::size_t device) {
    auto const& direction = world.devices.motors[device].direction;
    std::uint32_t bits = 0;
    for (std::size_t motor = 0; motor < direction.size(); ++motor) {
        bits |= static_cast<std::uint32_t>(direction[motor]) << motor;
    }
    return bits;
}

}  // namespace pogosim
