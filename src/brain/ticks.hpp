// A tick of robots that no program drives: every 16 ms of their own clocks, as the main loop of programs does it at
// its usual 60 Hz.
#pragma once

#include <cstdint>

#include "brain/brain.hpp"
#include "device/clock.hpp"
#include "device/infrared.hpp"
#include "device/motors.hpp"
#include "device/sensing.hpp"
#include "device/set_up.hpp"

namespace pogosim {

/// Calls tick(robot) for each robot of the range that is due. Before the call, its accelerometer measures and commands
/// of the remote control are obeyed; after it, its motors command its velocity.
template <class Tick>
void run_due_robots(World& world, RobotRange range, Tick const& tick) {
    std::int64_t const now_us = time_us(world);
    for (std::uint32_t robot = range.first; robot < range.last; ++robot) {
        if (now_us < world.devices.clock_us[robot]) {
            continue;
        }
        measure_at_tick(world, robot);
        if (world.mailboxes.has_commands(robot) && obey_commands(world, robot)) [[unlikely]] {
            reset_devices(world, robot, now_us);
        }
        std::int64_t const began_us = world.devices.clock_us[robot];
        ++world.devices.ticks[robot];
        tick(robot);
        world.devices.clock_us[robot] += kUsualTickUs;
        drift_clock(world, robot, began_us);
        drive(world, robot);
    }
}

}  // namespace pogosim
