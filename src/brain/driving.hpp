// What brains without a program have in common: ticks of their robots, motor powers with a sign, messages.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "brain/brain.hpp"
#include "device/clock.hpp"
#include "device/infrared.hpp"
#include "device/motors.hpp"
#include "device/sensing.hpp"
#include "device/set_up.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Calls tick(robot) for each robot of the range that is due: every 16 ms of its own clock, as the main loop of
/// programs does it at its usual 60 Hz. Before the call, its accelerometer measures and commands of the remote control
/// are obeyed; after it, its motors command its velocity.
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

/// Direction bit with which a motor of this robot turns forwards.
inline std::uint8_t forward_direction(World const& world, std::uint32_t robot, std::size_t motor) {
    std::vector<Drive> const& drives = world.spec_of(robot).model.drives;
    auto const drive = std::ranges::find(drives, motor, &Drive::motor);
    return drive != drives.end() ? drive->forward : Motors{}.direction[motor];
}

/// -1023 to 1023, beyond which powers are cut; positive is forward.
inline void set_signed_power(World& world, std::uint32_t robot, std::size_t motor, std::int32_t power) {
    std::int32_t const most = kFullMotorPower;
    std::uint8_t const forward = forward_direction(world, robot, motor);
    std::uint8_t const backward = forward == 0 ? 1 : 0;
    int const id = static_cast<int>(motor);
    set_motor_power(world, robot, id, static_cast<std::uint16_t>(std::abs(std::clamp(power, -most, most))));
    set_motor_direction(world, robot, id, power < 0 ? backward : forward);
}

/// Sends a message of up to kMostPayloadBytes through these emitters (bit d: emitter d) at the power of the robot's
/// port, unless the robot is muted.
void send_message(World& world, std::uint32_t robot, std::uint8_t emitters, std::span<std::byte const> payload);

}  // namespace pogosim
