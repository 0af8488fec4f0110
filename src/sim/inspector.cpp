#include "sim/inspector.hpp"

#include <algorithm>
#include <array>

#include "robot/sensing.hpp"

namespace pogosim {

namespace {

constexpr double kSecondsPerUs = 1e-6;

Object const& object_of(World const& world, std::uint32_t robot) {
    return *std::ranges::find(world.objects, robot, &Object::robot);
}

/// Of the middle of a membrane, or of its only body.
void add_motion(World const& world, Object const& object, Inspection& inspection) {
    Bodies const& bodies = world.bodies;
    Vec2 velocity_mm_s;
    for (std::uint32_t k = 0; k < object.body_count; ++k) {
        velocity_mm_s = velocity_mm_s + bodies.velocity_mm_s[object.body + k];
    }
    inspection.has_body = true;
    inspection.position_mm = wrapped(world, centre_mm(world, object));
    inspection.speed_mm_s = length(velocity_mm_s) / static_cast<float>(object.body_count);
    if (object.body_count == 1) {
        inspection.heading_rad = wrap_angle(bodies.heading_rad[object.body]);
        inspection.angular_velocity_rad_s = bodies.angular_velocity_rad_s[object.body];
    }
}

void add_controller(Controller const& controller, Inspection& inspection) {
    inspection.ticks = controller.loop.ticks;
    std::ranges::copy(controller.motors.power, inspection.motor_power.begin());
    std::ranges::copy(controller.motors.direction, inspection.motor_direction.begin());
    inspection.messages_sent = controller.messages_sent;
    inspection.messages_received = controller.messages_received;
}

void add_sensors(World const& world, std::uint32_t body, Controller const& controller, Inspection& inspection) {
    for (std::size_t sensor = 0; sensor < inspection.light.size(); ++sensor) {
        inspection.light[sensor] = light_at_sensor(world, body, sensor);
    }
    inspection.acceleration_m_s2 = acceleration_m_s2(world, body, controller.accelerometer);
}

}  // namespace

Inspection Inspector::inspect(std::uint32_t robot) {
    Object const& object = object_of(world_, robot);
    Controller const& controller = controllers_.controller_of(robot);
    Inspection inspection;
    inspection.robot = robot;
    inspection.clock_s = static_cast<double>(controllers_.clock_us(robot)) * kSecondsPerUs;
    inspection.id = world_.robots.id[robot];
    inspection.category = world_.categories[world_.robots.category[robot]].name;
    inspection.led = world_.robots.led[robot];
    inspection.messages_waiting = static_cast<std::size_t>(world_.mailboxes.size(robot));
    add_controller(controller, inspection);
    if (object.body != kNone) {
        add_motion(world_, object, inspection);
        add_sensors(world_, object.body, controller, inspection);
    }
    inspection.neighbours = neighbours_of(robot);
    inspection.columns = rows_.last_row(robot);
    inspection.lines.assign(lines_.of(robot).begin(), lines_.of(robot).end());
    return inspection;
}

std::vector<Neighbour> Inspector::neighbours_of(std::uint32_t robot) {
    std::vector<Neighbour> neighbours;
    float const range_mm = controllers_.ir_range_mm(robot);
    bool const is_outline = world_.spec_of(robot).emitters == Emitters::outline;
    visibility_.update(world_);
    for (Receiver const& receiver : visibility_.receivers(world_, robot, kAllFaces, range_mm)) {
        float distance_mm = length(receiver.from_emitter_mm);
        if (is_outline || world_.spec_of(receiver.robot).emitters == Emitters::outline) {
            // From the outline to the nearest point where the other one has emitters.
            std::uint32_t const disk = is_outline ? receiver.robot : robot;
            float const rim_mm = emitter_radius_mm(world_, disk);
            auto const way =
                visibility_.to_outline(world_, disk, is_outline ? robot : receiver.robot, rim_mm + range_mm);
            distance_mm = std::max(length(way.value_or(Vec2{})) - rim_mm, 0.0F);
        }
        neighbours.push_back({.id = world_.robots.id[receiver.robot],
                              .category = world_.categories[world_.robots.category[receiver.robot]].name,
                              .distance_mm = distance_mm,
                              .emitters = receiver.emitters});
    }
    std::ranges::sort(neighbours, {}, &Neighbour::id);
    return neighbours;
}

}  // namespace pogosim
