#include "device/motors.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "interface/pogobase_inside.hpp"

namespace pogosim {

namespace {

constexpr auto kFullPower = static_cast<float>(kFullMotorPower);
constexpr float kLinearNoiseUnit = 100.0F;  // mm/s per unit of linear_noise_stddev
constexpr std::array kSign{-1.0F, 1.0F};    // of a power, backwards and forwards

/// Power with which a motor turns forwards. The bias drives the left motor forwards and the right one backwards.
/// The direction is not a branch: which way a robot turns cannot be predicted.
float signed_power(Motors const& motors, Drive const& drive) {
    float const power = motors.power[drive.motor];
    float const forwards = kSign[motors.direction[drive.motor] == drive.forward ? 1 : 0] * power;
    switch (drive.motor) {
        case motorL:
            return forwards + motors.bias;
        case motorR:
            return forwards - motors.bias;
        default:
            return forwards;
    }
}

/// Sums over the motors of a robot: power, times what each of them gives.
struct DrivingPower {
    float linear = 0.0F;
    float angular = 0.0F;
};
DrivingPower driving_power(std::vector<Drive> const& drives, Motors const& motors) {
    DrivingPower sum;
    for (Drive const& drive : drives) {
        float const power = signed_power(motors, drive);
        sum.linear += drive.linear * power;
        sum.angular += drive.angular * power;
    }
    return sum;
}

}  // namespace

void command_velocity(World& world, std::uint32_t robot) {
    RobotSpec const& spec = world.spec_of(robot);
    DrivingPower const power = driving_power(spec.model.drives, world.devices.motors[robot]);
    float const speed = spec.max_linear_speed_mm_s * power.linear / kFullPower;
    Vec2 velocity = speed * world.bodies.heading_dir[world.robots.body[robot]];
    float angular_velocity = spec.max_angular_speed_rad_s * power.angular / kFullPower;

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
