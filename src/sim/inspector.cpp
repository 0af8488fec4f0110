#include "sim/inspector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>

#include "device/infrared.hpp"
#include "device/sensing.hpp"
#include "device/switched_off.hpp"
#include "process/variable_text.hpp"
#include "world/observed_motion.hpp"

namespace pogosim {

namespace {

constexpr double kSecondsPerUs = 1e-6;
std::vector<ProgramVariables::Variable> const kNoVariables;

Object const& object_of(World const& world, std::uint32_t robot) {
    return *std::ranges::find(world.objects, robot, &Object::robot);
}

/// Velocity of the object's middle.
void add_motion(World const& world, Object const& object, Inspection& inspection) {
    auto const [position_mm, heading_rad] = pose_of(world, object);
    inspection.has_body = true;
    inspection.position_mm = position_mm;
    inspection.heading_rad = heading_rad;
    inspection.angular_velocity_rad_s = observed_motion(world, object).angular_velocity_rad_s;
}

/// Links of the object's body: a membrane has none.
void add_links(World const& world, Object const& object, Inspection& inspection) {
    for (Link const& link : world.links) {
        if (!link.is_cut && (link.a == object.body || link.b == object.body)) {
            bool const is_first = inspection.links++ == 0;
            inspection.least_tension_n =
                is_first ? link.tension_n : std::min(inspection.least_tension_n, link.tension_n);
            inspection.most_tension_n = is_first ? link.tension_n : std::max(inspection.most_tension_n, link.tension_n);
        }
    }
}

void add_devices(Devices const& devices, std::size_t robot, Inspection& inspection) {
    std::ranges::copy(devices.motors[robot].power, inspection.motor_power.begin());
    std::ranges::copy(devices.motors[robot].direction, inspection.motor_direction.begin());
    inspection.messages_sent = devices.messages_sent[robot];
    inspection.messages_received = devices.messages_received[robot];
    inspection.is_muted = devices.infrared[robot].is_muted != 0;
    std::ranges::copy(devices.magnetometer[robot].last, inspection.magnetometer.begin());
    inspection.magnetometer_samples = devices.magnetometer[robot].samples;
}

void add_sensors(World const& world, std::uint32_t robot, Inspection& inspection) {
    for (std::size_t sensor = 0; sensor < world.spec_of(robot).model.light_sensors.size(); ++sensor) {
        inspection.light.push_back(light_at_sensor(world, robot, sensor));
    }
    inspection.acceleration_m_s2 = acceleration_m_s2(world, robot);
}

}  // namespace

Inspection Inspector::inspect(std::uint32_t robot) {
    Object const& object = object_of(world_, robot);
    Inspection inspection;
    inspection.robot = robot;
    inspection.clock_s = static_cast<double>(clock_us(world_, robot)) * kSecondsPerUs;
    inspection.id = world_.robots.id[robot];
    inspection.category = world_.categories[world_.robots.category[robot]].name;
    inspection.led = world_.robots.led[robot];
    inspection.messages_waiting = static_cast<std::size_t>(world_.mailboxes.size(robot));
    inspection.ticks = controllers_.ticks(robot);
    add_devices(world_.devices, robot, inspection);
    if (object.body != kNone) {
        add_motion(world_, object, inspection);
        add_links(world_, object, inspection);
        add_sensors(world_, robot, inspection);
        auto const [shortly_mm, shortly_s] = recent_motion_.of(robot, Inspection::kSpeedWindowS);
        inspection.speed_mm_s = shortly_s > 0.0 ? shortly_mm / static_cast<float>(shortly_s) : 0.0F;
        RecentMotion::Displacement const recent = recent_motion_.of(robot, RecentMotion::kWindowS);
        inspection.moved_mm = recent.distance_mm;
        inspection.moved_during_s = recent.during_s;
        inspection.touches = names_of_touched(object);
    }
    inspection.neighbours = neighbours_of(robot);
    add_variables(robot, inspection);
    std::tie(inspection.columns_time_s, inspection.columns) = rows_.last_row(robot);
    inspection.lines.assign(lines_.of(robot).begin(), lines_.of(robot).end());
    return inspection;
}

void Inspector::add_variables(std::uint32_t robot, Inspection& inspection) {
    for (auto const& brain : brains_) {
        std::ranges::move(brain->texts_of(robot), std::back_inserter(inspection.variables));
    }
    RobotMemory const* const memory = controllers_.own_memory();
    std::size_t const data_bytes = controllers_.user_data_bytes();
    if (memory == nullptr && data_bytes == 0) {
        return;
    }
    if (!variables_) {
        variables_ = variables_of(controllers_.image());
    }
    inspection.no_variables = variables_->why_unknown;
    if (variables_->user_data != nullptr) {
        add_texts("", *variables_->user_data, {controllers_.controller_of(robot).user_data, data_bytes},
                  inspection.variables);
    }
    std::vector<std::byte> bytes;
    for (ProgramVariables::Variable const& variable : memory != nullptr ? variables_->own : kNoVariables) {
        bytes.resize(variable.type->bytes);
        auto const address = controllers_.image().load_address + variable.address;
        memory->read(robot, reinterpret_cast<std::byte const*>(address), bytes);
        add_texts(variable.name, *variable.type, bytes, inspection.variables);
    }
}

/// Objects of its own category are called robots.
std::vector<std::string> Inspector::names_of_touched(Object const& object) const {
    Touched const touched = touched_by(world_, object, gaps_);
    std::vector<std::string> names;
    if (touched.wall) {
        names.emplace_back("wall");
    }
    for (std::uint32_t const i : touched.objects) {
        Object const& other = world_.objects[i];
        std::string const& category = world_.categories[other.category].name;
        bool const is_alike = category == world_.categories[object.category].name;
        names.push_back(fmt::format("{} {}", is_alike ? "robot" : category, other.id));
    }
    return names;
}

std::vector<Neighbour> Inspector::neighbours_of(std::uint32_t robot) {
    std::vector<Neighbour> neighbours;
    float const range_mm = ir_range_mm(world_, robot);
    bool const is_outline = world_.spec_of(robot).model.sends_along_outline;
    visibility_.update(world_);
    for (Receiver const& receiver : visibility_.receivers(world_, robot, kAllFaces, range_mm)) {
        float distance_mm = length(receiver.from_emitter_mm);
        if (is_outline || world_.spec_of(receiver.robot).model.sends_along_outline) {
            // From the outline to the nearest point where the other one has emitters.
            std::uint32_t const disk = is_outline ? receiver.robot : robot;
            float const rim_mm = face_reach_mm(world_, disk);
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
