// What goes on in the robots at every step of the simulation: batteries, and accelerometers that measure at each one.
// Runs without such robots take no time for it.
#pragma once

#include <cstdint>
#include <vector>

#include "world/world.hpp"

namespace pogosim {

class StepChips {
public:
    /// Finds the robots that have such chips.
    explicit StepChips(World const& world);

    /// To be called at the beginning of each step: accelerometers measure, and batteries give what the robots have used
    /// since the last call, with motors and LEDs as they are now. Returns the robots whose batteries are empty, which
    /// are to be switched off; warns of the first one. When a supervisor switches such a robot on again, its battery is
    /// full.
    std::vector<std::uint32_t> const& begin_step(World& world, std::int64_t now_us);

private:
    void drain_battery(World& world, std::uint32_t robot, double duration_s);

    std::vector<std::uint32_t> measured_;      // robots with an accelerometer that measures at each step
    std::vector<std::uint32_t> with_battery_;  // robots whose battery empties
    std::vector<std::uint32_t> empty_;         // since this step
    bool has_warned_ = false;
};

}  // namespace pogosim
