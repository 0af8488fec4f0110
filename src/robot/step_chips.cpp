#include "robot/step_chips.hpp"

#include <utility>

#include "base/log.hpp"
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

void StepChips::install(std::span<Controller> controllers) {
    for (std::uint32_t i = 0; i < controllers.size(); ++i) {
        RobotSpec const& spec = world_.spec_of(i);
        if (spec.sensors.acceleration == ImuAcceleration::original) {
            controllers[i].accelerometer.at_each_step = true;
            measured_.push_back(i);
        }
        if (spec.battery) {
            controllers[i].battery = initial_battery(*spec.battery);
            with_battery_.push_back(i);
        }
    }
}

std::vector<std::uint32_t> const& StepChips::begin_step(std::span<Controller> controllers, std::int64_t now_us) {
    for (std::uint32_t const robot : measured_) {
        measure_velocity(world_, robot, now_us, controllers[robot].accelerometer);
    }
    auto const duration_s = kSecondsPerMicrosecond * static_cast<double>(now_us - drained_us_);
    drained_us_ = now_us;
    empty_.clear();
    for (std::uint32_t const robot : with_battery_) {
        if (is_alive(world_, robot)) {
            drain_battery(robot, controllers[robot], duration_s);
        }
    }
    return empty_;
}

void StepChips::drain_battery(std::uint32_t robot, Controller& self, double duration_s) {
    RobotSpec const& spec = world_.spec_of(robot);
    if (charge_left(self.battery, *spec.battery) <= 0.0) {
        self.battery = {};
    }
    double const share = spec.has_wheels ? motor_share(self.motors) : 0.0;
    drain(self.battery, *spec.battery, current_ma(*spec.battery, share, world_.robots.led[robot]), duration_s);
    if (charge_left(self.battery, *spec.battery) <= 0.0) {
        empty_.push_back(robot);
        if (!std::exchange(has_warned_, true)) {
            log().warn(
                "t = {:.4f} s: the battery of robot #{} of category '{}' is empty: the robot is switched off, and "
                "so is every other one whose battery empties later",
                world_.time_s(), world_.robots.id[robot], world_.categories[world_.robots.category[robot]].name);
        }
    }
}

}  // namespace pogosim
