#include "device/sensing.hpp"

#include <array>
#include <cstdint>

#include "world/light_cell.hpp"

namespace pogosim {

namespace {

constexpr float kMmPerM = 1000.0F;

}  // namespace

std::size_t light_cell_at_sensor(World const& world, std::uint32_t robot, std::size_t sensor) {
    Bodies const& bodies = world.bodies;
    std::uint32_t const body = world.robots.body[robot];
    PartPlace const& place = world.spec_of(robot).model.light_sensors[sensor].place;
    Vec2 const axis = bodies.heading_dir[body];
    Vec2 const offset = bodies.radius_mm[body] * rotate(place.radii, axis) + rotate(place.offset_mm, axis);
    return cell_under(world.light, wrapped(world, bodies.position_mm[body] + offset));
}

int light_at_sensor(World const& world, std::uint32_t robot, std::size_t sensor) {
    return world.light.level[light_cell_at_sensor(world, robot, sensor)];
}

double mean_light(World const& world, std::uint32_t robot) {
    std::size_t const sensors = world.spec_of(robot).model.light_sensors.size();
    if (sensors == 0) {
        return world.light.at(wrapped(world, world.bodies.position_mm[world.robots.body[robot]]));
    }
    double sum = 0.0;
    for (std::size_t sensor = 0; sensor < sensors; ++sensor) {
        sum += light_at_sensor(world, robot, sensor);
    }
    return sum / static_cast<double>(sensors);
}

double light_of(World const& world, Object const& object) {
    bool const has_sensors = object.robot != kNone && object.body_count == 1;
    return has_sensors ? mean_light(world, object.robot) : world.light.at(wrapped(world, centre_mm(world, object)));
}

Vec2 acceleration_m_s2(World const& world, std::uint32_t robot) {
    Accelerometer const& meter = world.devices.accelerometer[robot];
    if (meter.interval_s <= 0.0F) {
        return {};
    }
    Vec2 const change = observed_velocity_mm_s(world, meter.current) - observed_velocity_mm_s(world, meter.previous);
    Vec2 const axis = world.bodies.heading_dir[world.robots.body[robot]];
    return (1.0F / (meter.interval_s * kMmPerM)) * Vec2{dot(change, axis), cross(axis, change)};
}

}  // namespace pogosim
