#include "device/sensors.hpp"

#include <algorithm>

#include "device/chips.hpp"
#include "device/sensing.hpp"
#include "world/observed_motion.hpp"

namespace pogosim {

namespace {

/// One chip on all three axes.
struct ImuAxes {
    float noise_stddev;
    float most;
    float step;
};

void measure(std::array<float, 3>& values, ImuAxes const& axes, bool in_whole_counts, RandomStream& noise) {
    for (float& value : values) {
        if (axes.noise_stddev > 0.0F) {
            value += axes.noise_stddev * noise.normal();
        }
        value = std::clamp(value, -axes.most, axes.most);
        if (in_whole_counts) {
            value = in_counts(value, axes.step);
        }
    }
}

}  // namespace

float felt_upwards_m_s2(float acceleration_m_s2, bool has_gravity) {
    return has_gravity ? acceleration_m_s2 + kGravity : acceleration_m_s2;
}

ImuReading imu_reading(SensorSpec const& spec, Vec2 acceleration_m_s2, float turning_rad_s, RandomStream& noise) {
    ImuReading reading;
    reading.acceleration = {acceleration_m_s2.y, acceleration_m_s2.x, felt_upwards_m_s2(0.0F, spec.imu_gravity)};
    reading.angular_velocity = {0.0F, 0.0F, 0.0F - turning_rad_s};
    measure(reading.acceleration,
            {.noise_stddev = spec.acceleration_noise_m_s2, .most = kMaxAcceleration, .step = kAccelerationStep},
            spec.imu_quantization, noise);
    measure(reading.angular_velocity,
            {.noise_stddev = spec.angular_noise_rad_s, .most = kMaxAngularVelocity, .step = kAngularVelocityStep},
            spec.imu_quantization, noise);
    if (spec.acceleration == ImuAcceleration::original) {
        constexpr float dm_per_m = 10.0F;
        std::ranges::for_each(reading.acceleration, [](float& value) { value *= dm_per_m; });
    }
    return reading;
}

ImuReading read_imu(World& world, std::uint32_t robot) {
    float const turning_rad_s = observed_motion(world, world.robots.body[robot]).angular_velocity_rad_s;
    return imu_reading(world.spec_of(robot).sensors, acceleration_m_s2(world, robot), turning_rad_s,
                       world.devices.imu_noise[robot]);
}

std::int16_t read_photosensor(World& world, std::uint32_t robot, std::size_t sensor) {
    return read_photosensor(world, robot, sensor, light_at_sensor(world, robot, sensor));
}

std::int16_t read_photosensor(World& world, std::uint32_t robot, std::size_t sensor, int light) {
    RobotSpec const& spec = world.spec_of(robot);
    int level = light + world.devices.photosensor_bias[robot][sensor];
    if (float const noise = spec.photosensor_noise_stddev; noise > 0.0F) {
        level += static_cast<int>(noise * world.robots.stream[robot].normal());
    }
    level = converted_light(level, spec.sensors.photosensor_bits);
    return static_cast<std::int16_t>(std::clamp<int>(level, INT16_MIN, INT16_MAX));
}

}  // namespace pogosim
