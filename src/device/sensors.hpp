// What a program reads of the inertial measurement unit and the light sensors of its robot.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "base/random.hpp"
#include "base/vec2.hpp"
#include "world/world.hpp"

namespace pogosim {

struct ImuReading {
    std::array<float, 3> acceleration{};      // to the right, forward, up
    std::array<float, 3> angular_velocity{};  // rad/s; [2] counter-clockwise seen from above
};

/// What the accelerometer feels upwards, m/s2, of a body that accelerates upwards: its weight is added, so it is g at
/// rest and 0 in free fall. Without gravity: the acceleration alone.
float felt_upwards_m_s2(float acceleration_m_s2, bool has_gravity);

/// `acceleration_m_s2`: x forward, y to the right. `turning_rad_s`: clockwise on the screen. Draws from `noise` only if
/// the spec has noise.
ImuReading imu_reading(SensorSpec const& spec, Vec2 acceleration_m_s2, float turning_rad_s, RandomStream& noise);

/// What a robot reads, which has a body.
ImuReading read_imu(World& world, std::uint32_t robot);

/// Said once to a program that reads a photosensor where no light can be.
inline constexpr std::string_view kNoLamps =
    "there is no lamp in this world, so it is dark everywhere; add an object of type static_light or another lamp to "
    "the configuration";

/// Sensor counts at a photosensor (0 back, 1 front left, 2 front right) of a robot that has a body, with its bias, its
/// noise, which is drawn here, and the bits of its converter.
std::int16_t read_photosensor(World& world, std::uint32_t robot, std::size_t sensor);

/// The same where the light at the sensor is known, sensor counts.
std::int16_t read_photosensor(World& world, std::uint32_t robot, std::size_t sensor, int light);

}  // namespace pogosim
