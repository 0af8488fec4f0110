#include "device/switched_off.hpp"

#include <algorithm>
#include <utility>

#include "device/clock.hpp"

namespace pogosim {

void set_alive(World& world, std::uint32_t robot, bool alive) {
    if (alive == is_alive(world, robot)) {
        return;
    }
    auto const entry = std::ranges::lower_bound(world.switched_off, robot);
    auto const place = world.when_switched_on.begin() + (entry - world.switched_off.begin());
    if (alive) {
        wake(world, *place);
        world.when_switched_on.erase(place);
        world.switched_off.erase(entry);
    } else {
        world.switched_off.insert(entry, robot);
        rest(world, *world.when_switched_on.insert(place, {.robot = robot}));
    }
}

SwitchedOff* find_switched_off(World& world, std::uint32_t robot) {
    auto const place = std::ranges::lower_bound(world.when_switched_on, robot, {}, &SwitchedOff::robot);
    return place != world.when_switched_on.end() && place->robot == robot ? &*place : nullptr;
}

std::int64_t clock_us(World const& world, std::uint32_t robot) {
    auto const place = std::ranges::lower_bound(world.when_switched_on, robot, {}, &SwitchedOff::robot);
    return place != world.when_switched_on.end() && place->robot == robot ? place->clock_us
                                                                          : world.devices.clock_us[robot];
}

void wake(World& world, SwitchedOff const& self) {
    world.devices.clock_us[self.robot] = std::max(self.clock_us, time_us(world));
    world.robots.led[self.robot] = self.leds;
}

/// Switches the robot off by a clock that is never due, so that what runs the robots needs no branch for it. Does
/// nothing if it is off already.
void rest(World& world, SwitchedOff& self) {
    std::int64_t const clock_us = std::exchange(world.devices.clock_us[self.robot], kNever);
    Leds const leds = std::exchange(world.robots.led[self.robot], {});
    if (clock_us < kNever) {
        self.clock_us = clock_us;
        self.leds = leds;
    }
}

void hold_switched_off(World& world) {
    for (SwitchedOff const& self : world.when_switched_on) {
        if (world.devices.motors[self.robot].driven && world.spec_of(self.robot).model.has_motors()) {
            world.robots.command[self.robot] = {.velocity_mm_s = {}, .angular_velocity_rad_s = 0.0F, .pending = true};
        }
    }
}

}  // namespace pogosim
