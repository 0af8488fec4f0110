#include "world/saved_world.hpp"

#include <array>
#include <cstddef>

namespace pogosim {

namespace {

template <class Self, class State>
void visit_bodies(Self& bodies, State& state) {
    state(bodies.position_mm, bodies.heading_rad, bodies.heading_dir, bodies.velocity_mm_s,
          bodies.angular_velocity_rad_s, bodies.start_mm, bodies.start_rad, bodies.written);
}

template <class Self, class State>
void visit_devices(Self& devices, State& state) {
    state(devices.clock_us, devices.clock_drift_us, devices.motors, devices.photosensor_bias, devices.accelerometer,
          devices.imu_noise, devices.magnetometer, devices.battery, devices.flash, devices.ir_power, devices.infrared,
          devices.sent_rate, devices.ticks, devices.messages_sent, devices.messages_received, devices.drained_us);
}

template <class Self, class State>
void visit_links(Self& world, State& state) {
    std::size_t categories = world.link_categories.size();
    state(categories);
    if constexpr (State::kIsReading) {
        world.link_categories.resize(categories);
    }
    for (auto& category : world.link_categories) {
        state(category.name, category.are_drawn);
    }
    state(world.links, world.link_changes);
}

template <class Self, class State>
void visit_lamps(Self& world, State& state) {
    std::size_t const expected = world.lamps.size();
    std::size_t lamps = expected;
    state(lamps);
    if (lamps != expected) {
        throw ForeignState("it has other lamps");
    }
    for (auto& lamp : world.lamps) {
        state(lamp.start_mm, lamp.setting);
    }
}

template <class Self, class State>
void visit_world(Self& world, State& state) {
    state(world.step, world.time_step_s, world.objects);
    visit_bodies(world.bodies, state);
    visit_links(world, state);
    state(world.robots.led, world.robots.command, world.robots.stream);
    visit_devices(world.devices, state);
    state(world.switched_off, world.when_switched_on);
    visit_lamps(world, state);
    state(world.light.level, world.air.transmissions, world.air.payloads);
}

/// Numbers of things, which are the same for all worlds of a configuration.
std::array<std::size_t, 6> counts(World const& world) {
    return {world.objects.size(), world.bodies.size(),      world.robots.led.size(),
            world.devices.size(), world.light.level.size(), world.devices.flash.size()};
}

}  // namespace

void append_world(World const& world, StateWriter& state) {
    visit_world(world, state);
    world.mailboxes.append_state(state);
}

void take_world(World& world, StateReader& state) {
    auto const expected = counts(world);
    double const time_step_s = world.time_step_s;
    visit_world(world, state);
    if (counts(world) != expected || world.time_step_s != time_step_s) {
        throw ForeignState("it has other objects");
    }
    world.mailboxes.take_state(state);
}

}  // namespace pogosim
