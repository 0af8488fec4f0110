#include "robot/assert_controllers.hpp"

#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>

#ifndef NDEBUG
namespace pogosim {

namespace {

void assert_motors(Motors const& motors, RobotSpec const& spec) {
    for (std::size_t motor = 0; motor < motors.power.size(); ++motor) {
        assert(motors.power[motor] <= motorFull);
        assert(motors.direction[motor] <= 1);
    }
    assert(motors.bias >= static_cast<float>(spec.motor_bias.min));
    assert(motors.bias <= static_cast<float>(spec.motor_bias.max));
}

}  // namespace

void assert_controllers(World const& world, std::span<Controller const> controllers) {
    constexpr std::uint8_t most_ir_power = 3;
    assert(controllers.size() == world.robots.size());
    for (std::size_t i = 0; i < controllers.size(); ++i) {
        RobotSpec const& spec = world.spec_of(i);
        assert(world.devices.clock_us[i] >= 0);
        assert(world.devices.ir_power[i] <= most_ir_power);
        assert(world.mailboxes.size(i) <= spec.ir.queue_size);
        assert_motors(world.devices.motors[i], spec);
        for (std::int32_t const bias : world.devices.photosensor_bias[i]) {
            assert(bias >= spec.photosensor_bias.min && bias <= spec.photosensor_bias.max);
        }
        VelocityCommand const& command = world.robots.command[i];
        assert(!command.pending || world.robots.body[i] != kNone);
        assert(std::isfinite(command.velocity_mm_s.x) && std::isfinite(command.velocity_mm_s.y));
        assert(std::isfinite(command.angular_velocity_rad_s));
    }
}

}  // namespace pogosim
#endif
