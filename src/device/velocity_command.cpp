#include "device/velocity_command.hpp"

#include <cstdint>

#include "interface/pogobase_inside.hpp"

namespace pogosim {

namespace {

constexpr float kFullPower = 1023.0F;
constexpr float kLinearNoiseUnit = 100.0F;  // mm/s per unit of linear_noise_stddev

/// Forward is direction bit 1 on the left and 0 on the right.
float signed_power(Motors const& motors, motor_id motor, std::uint8_t forward_bit) {
    float const power = motors.power[motor];
    return motors.direction[motor] == forward_bit ? power : -power;
}

}  // namespace

void command_velocity(World& world, std::size_t robot, Motors const& motors) {
    RobotSpec const& spec = world.spec_of(robot);
    float const left = signed_power(motors, motorL, 1) + motors.bias;
    float const right = signed_power(motors, motorR, 0) - motors.bias;

    float const speed = spec.max_linear_speed_mm_s * (left + right) / (2.0F * kFullPower);
    Vec2 velocity = speed * world.bodies.heading_dir[world.robots.body[robot]];
    float angular_velocity = spec.max_angular_speed_rad_s * (left - right) / (kFullPower / 2.0F);

    RandomStream& stream = world.robots.stream[robot];
    if (spec.linear_noise_stddev > 0.0F) {
        float const noise_mm_s = kLinearNoiseUnit * spec.linear_noise_stddev;
        velocity.x += noise_mm_s * stream.normal();
        velocity.y += noise_mm_s * stream.normal();
    }
    if (spec.angular_noise_stddev > 0.0F) {
        angular_velocity += spec.angular_noise_stddev * stream.normal();
    }
    world.robots.command[robot] = {
        .velocity_mm_s = velocity, .angular_velocity_rad_s = angular_velocity, .pending = true};
}

}  // namespace pogosim
