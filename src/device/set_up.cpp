#include "device/set_up.hpp"

#include <cmath>
#include <cstddef>

#include "device/battery.hpp"
#include "device/infrared.hpp"

namespace pogosim {

namespace {

constexpr std::uint64_t kImuStreams = std::uint64_t{7} << 32U;  // streams for the noise of inertial units

int draw_between(IntRange range, RandomStream& stream) {
    return range.min + static_cast<int>(stream.below(static_cast<std::uint32_t>(range.max - range.min) + 1U));
}

Devices blank_devices(std::size_t count) {
    Devices devices;
    devices.clock_us.resize(count);
    devices.clock_drift_us.resize(count);
    devices.motors.resize(count);
    devices.photosensor_bias.resize(count);
    devices.accelerometer.resize(count);
    devices.imu_noise.resize(count);
    devices.magnetometer.resize(count);
    devices.battery.resize(count);
    devices.flash.resize(count);
    devices.ir_power.resize(count, kUsualIrPower);
    devices.infrared.resize(count);
    devices.sent_rate.resize(count);
    devices.ticks.resize(count);
    devices.messages_sent.resize(count);
    devices.messages_received.resize(count);
    return devices;
}

}  // namespace

void set_up_devices(World& world, std::uint64_t seed) {
    world.devices = blank_devices(world.robots.size() + 1);
    Devices& devices = world.devices;
    for (std::uint32_t robot = 0; robot < world.robots.size(); ++robot) {
        RobotSpec const& spec = world.spec_of(robot);
        RandomStream& stream = world.robots.stream[robot];
        devices.imu_noise[robot] = RandomStream(seed, kImuStreams + robot);
        devices.motors[robot].bias = static_cast<float>(draw_between(spec.motor_bias, stream));
        for (std::int32_t& bias : devices.photosensor_bias[robot]) {
            bias = draw_between(spec.photosensor_bias, stream);
        }
        devices.clock_drift_us[robot] = std::lround(spec.clock_drift_stddev_us * stream.normal());
        devices.accelerometer[robot].at_each_step = spec.sensors.acceleration == ImuAcceleration::original;
        if (spec.battery) {
            devices.battery[robot] = initial_battery(*spec.battery);
        }
    }
}

void reset_devices(World& world, std::uint32_t robot, std::int64_t now_us) {
    Devices& devices = world.devices;
    Motors& motors = devices.motors[robot];
    motors.power = {};
    motors.direction = motors.stored_direction;
    devices.ir_power[robot] = kUsualIrPower;
    devices.sent_rate[robot] = {};
    ++devices.infrared[robot].restarts;
    initialise_infrared(world, robot);
    devices.clock_us[robot] = now_us;
    devices.ticks[robot] = 0;
    world.robots.led[robot] = {};
}

}  // namespace pogosim
