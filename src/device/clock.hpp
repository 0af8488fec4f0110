// Clocks of robots, us. Each has its own, which drifts; that of a robot that is not due stands ahead of the step's.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "world/world.hpp"

namespace pogosim {

/// From tick to tick at 60 Hz, in whole milliseconds, as the main loop of programs makes it without another request.
inline constexpr std::int64_t kUsualTickUs = 16000;

// Code that takes no time may wait for something in a loop. Beyond a number of calls that no program needs in one step,
// each call takes the time that it takes on a robot.
inline constexpr int kFreeCalls = 1000;      // of each tick, and after each sleep
inline constexpr std::int64_t kCallUs = 10;  // of a processor with 21 MHz

/// Time of the step.
inline std::int64_t time_us(World const& world) {
    constexpr double us_per_s = 1e6;
    return std::llround(world.time_s() * us_per_s);
}

/// Adds the drift of a robot's clock for the time since it showed `since_us`: once for each tick, and never so much
/// that the clock turns back.
inline void drift_clock(World& world, std::uint32_t robot, std::int64_t since_us) {
    std::int64_t& clock_us = world.devices.clock_us[robot];
    std::int64_t const slept_us = clock_us - since_us;
    clock_us += std::max(world.devices.clock_drift_us[robot], -slept_us / 2);
}

/// The clock of a robot goes on by the time that its code has taken, us. It shows whole microseconds; what is left of
/// them is in `rest_us`, and counts the next time.
inline void take_time(World& world, std::uint32_t robot, double us, double& rest_us) {
    rest_us += us;
    double const whole_us = std::floor(rest_us);
    std::int64_t& clock_us = world.devices.clock_us[robot];
    auto const most_us = static_cast<double>(std::max<std::int64_t>(0, kIdle - 1 - clock_us));
    clock_us += static_cast<std::int64_t>(std::min(whole_us, most_us));
    rest_us -= whole_us;
}

}  // namespace pogosim
