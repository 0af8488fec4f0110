// Readings of a robot's sensors without noise and bias.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "world/observed_motion.hpp"
#include "world/world.hpp"

namespace pogosim {

/// The cell of the light map, as an index into its levels, at a light sensor of a robot that has a body.
std::size_t light_cell_at_sensor(World const& world, std::uint32_t robot, std::size_t sensor);

/// Light level at a light sensor of a robot that has a body, sensor counts.
int light_at_sensor(World const& world, std::uint32_t robot, std::size_t sensor);

/// Mean of its light sensors, sensor counts; without any, the light at its centre.
double mean_light(World const& world, std::uint32_t robot);

/// Light at an object, sensor counts, without noise: mean of the sensors of a rigid robot; of others, in the middle.
double light_of(World const& world, Object const& object);

/// An accelerometer notes the velocity of its robot at this time.
inline void measure_velocity(World& world, std::uint32_t robot, std::int64_t now_us) {
    constexpr float seconds_per_us = 1e-6F;
    std::uint32_t const body = world.robots.body[robot];
    if (body == kNone) {
        return;
    }
    Accelerometer& meter = world.devices.accelerometer[robot];
    meter.previous = meter.current;
    meter.current = last_step(world, body);
    bool const first = !std::exchange(meter.has_measured, true);
    meter.interval_s = first ? 0.0F : static_cast<float>(now_us - meter.current_us) * seconds_per_us;
    meter.current_us = now_us;
}

/// The same at a tick, by the robot's own clock: its ticks are evenly spaced there, and do not coincide with steps.
inline void measure_at_tick(World& world, std::uint32_t robot) {
    if (!world.devices.accelerometer[robot].at_each_step) {
        measure_velocity(world, robot, world.devices.clock_us[robot]);
    }
}

/// Mean acceleration between the last two measurements in the robot's frame, m/s2: x forward, y to the right.
Vec2 acceleration_m_s2(World const& world, std::uint32_t robot);

}  // namespace pogosim
