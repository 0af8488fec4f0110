// What goes on in the robots at every step of the simulation: batteries, and accelerometers that measure at each one.
// Runs without such robots take no time for it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "robot/controller.hpp"
#include "world/world.hpp"

namespace pogosim {

class StepChips {
public:
    /// `world` outlives this.
    explicit StepChips(World const& world) : world_(world) {}

    /// Finds the robots that have such chips, and fills their batteries. Call it once, before all else.
    void install(std::span<Controller> controllers);

    /// To be called at the beginning of each step, with the same controllers: accelerometers measure, and batteries
    /// give what the robots have used since the last call, with motors and LEDs as they are now. Returns the robots
    /// whose batteries are empty and which are to be switched off; warns of the first one. When a supervisor switches
    /// such a robot on again, its battery is full.
    std::vector<std::uint32_t> const& begin_step(std::span<Controller> controllers, std::int64_t now_us);

private:
    void drain_battery(std::uint32_t robot, Controller& self, double duration_s);

    World const& world_;
    std::vector<std::uint32_t> measured_;      // robots with an accelerometer that measures at each step
    std::vector<std::uint32_t> with_battery_;  // robots whose battery empties
    std::vector<std::uint32_t> empty_;         // since this step
    std::int64_t drained_us_ = 0;              // time up to which batteries have been emptied
    bool has_warned_ = false;
};

}  // namespace pogosim
