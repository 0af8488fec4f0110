// What goes on in the robots at every step of the simulation: batteries, and accelerometers that measure at each one.
// Runs without such robots take no time for it.
#include <cstdint>
#include <utility>

#include "base/log.hpp"
#include "robot/controllers.hpp"
#include "robot/sensing.hpp"

namespace pogosim {

namespace {

constexpr double kSecondsPerMicrosecond = 1e-6;
constexpr double kFullPower = 1023.0;

/// Sum over the motors of power divided by full power.
double motor_share(Motors const& motors) {
    double power = 0.0;
    for (std::uint16_t const of_one : motors.power) {
        power += of_one;
    }
    return power / kFullPower;
}

}  // namespace

void Controllers::note_chips() {
    for (std::uint32_t i = 0; i < controllers_.size(); ++i) {
        RobotSpec const& spec = world_.spec_of(i);
        if (spec.sensors.acceleration == ImuAcceleration::original) {
            controllers_[i].accelerometer.at_each_step = true;
            measured_each_step_.push_back(i);
        }
        if (spec.battery) {
            controllers_[i].battery = initial_battery(*spec.battery);
            with_battery_.push_back(i);
        }
    }
}

void Controllers::measure_each_step() {
    for (std::uint32_t const robot : measured_each_step_) {
        measure_velocity(world_, robot, step_us_, controllers_[robot].accelerometer);
    }
}

/// For the time since the last call, with the motors and LEDs as they have been set in it.
void Controllers::drain_batteries() {
    auto const duration_s = kSecondsPerMicrosecond * static_cast<double>(step_us_ - drained_us_);
    drained_us_ = step_us_;
    for (std::uint32_t const robot : with_battery_) {
        if (is_alive(world_, robot)) {
            drain_battery(robot, duration_s);
        }
    }
}

/// A robot whose battery is empty is switched off. When a supervisor switches it on again, its battery is full.
void Controllers::drain_battery(std::uint32_t robot, double duration_s) {
    RobotSpec const& spec = world_.spec_of(robot);
    Controller& self = controllers_[robot];
    if (charge_left(self.battery, *spec.battery) <= 0.0) {
        self.battery = {};
    }
    double const share = spec.has_wheels ? motor_share(self.motors) : 0.0;
    drain(self.battery, *spec.battery, current_ma(*spec.battery, share, world_.robots.led[robot]), duration_s);
    if (charge_left(self.battery, *spec.battery) <= 0.0) {
        set_alive(robot, false);
        if (!std::exchange(has_warned_of_battery_, true)) {
            log().warn(
                "t = {:.4f} s: the battery of robot #{} of category '{}' is empty: the robot is switched off, and "
                "so is every other one whose battery empties later",
                world_.time_s(), world_.robots.id[robot], world_.categories[world_.robots.category[robot]].name);
        }
    }
}

}  // namespace pogosim
