// Robots that are switched off, and on again.
#include <algorithm>
#include <cstdint>
#include <utility>

#include "robot/controllers.hpp"

namespace pogosim {

void Controllers::set_alive(std::uint32_t robot, bool alive) {
    if (alive == is_alive(world_, robot)) {
        return;
    }
    auto const place = std::ranges::lower_bound(switched_off_, robot, {}, &SwitchedOff::robot);
    std::vector<std::uint32_t>& switched_off = world_.switched_off;
    auto const entry = std::ranges::lower_bound(switched_off, robot);
    if (alive) {
        wake(*place);
        switched_off_.erase(place);
        switched_off.erase(entry);
    } else {
        switched_off.insert(entry, robot);
        rest(*switched_off_.insert(place, {.robot = robot}));
    }
}

Controllers::SwitchedOff* Controllers::find_switched_off(std::uint32_t robot) {
    auto const place = std::ranges::lower_bound(switched_off_, robot, {}, &SwitchedOff::robot);
    return place != switched_off_.end() && place->robot == robot ? &*place : nullptr;
}

std::int64_t Controllers::clock_us(std::uint32_t robot) const {
    auto const place = std::ranges::lower_bound(switched_off_, robot, {}, &SwitchedOff::robot);
    return place != switched_off_.end() && place->robot == robot ? place->clock_us : controllers_[robot].clock_us;
}

void Controllers::wake(SwitchedOff const& self) {
    controllers_[self.robot].clock_us = std::max(self.clock_us, now_us());
    world_.robots.led[self.robot] = self.leds;
}

/// Switches the robot off by a clock that is never due, so that run_robots() needs no branch for it. Does nothing if it
/// is off already.
void Controllers::rest(SwitchedOff& self) {
    std::int64_t const clock_us = std::exchange(controllers_[self.robot].clock_us, kNever);
    Leds const leds = std::exchange(world_.robots.led[self.robot], {});
    if (clock_us < kNever) {
        self.clock_us = clock_us;
        self.leds = leds;
    }
}

/// Commands rest, as motors without power do, but without their noise.
void Controllers::hold_switched_off() {
    for (SwitchedOff const& self : switched_off_) {
        if (controllers_[self.robot].motors.driven && world_.spec_of(self.robot).has_wheels) {
            world_.robots.command[self.robot] = {.velocity_mm_s = {}, .angular_velocity_rad_s = 0.0F, .pending = true};
        }
    }
}

}  // namespace pogosim
