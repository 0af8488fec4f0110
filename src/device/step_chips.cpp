#include "device/step_chips.hpp"

#include <utility>

#include "base/log.hpp"
#include "device/battery.hpp"
#include "device/sensing.hpp"

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

StepChips::StepChips(World const& world) {
    for (std::uint32_t i = 0; i < world.robots.size(); ++i) {
        RobotSpec const& spec = world.spec_of(i);
        if (spec.sensors.acceleration == ImuAcceleration::original) {
            measured_.push_back(i);
        }
        if (spec.battery) {
            with_battery_.push_back(i);
        }
    }
}

std::vector<std::uint32_t> const& StepChips::begin_step(World& world, std::int64_t now_us) {
    for (std::uint32_t const robot : measured_) {
        measure_velocity(world, robot, now_us);
    }
    auto const duration_s =
        kSecondsPerMicrosecond * static_cast<double>(now_us - std::exchange(world.devices.drained_us, now_us));
    empty_.clear();
    for (std::uint32_t const robot : with_battery_) {
        if (is_alive(world, robot)) {
            drain_battery(world, robot, duration_s);
        }
    }
    return empty_;
}

void StepChips::drain_battery(World& world, std::uint32_t robot, double duration_s) {
    RobotSpec const& spec = world.spec_of(robot);
    Battery& battery = world.devices.battery[robot];
    if (charge_left(battery, *spec.battery) <= 0.0) {
        battery = {};
    }
    double const share = spec.model.has_motors() ? motor_share(world.devices.motors[robot]) : 0.0;
    drain(battery, *spec.battery, current_ma(*spec.battery, share, world.robots.led[robot]), duration_s);
    if (charge_left(battery, *spec.battery) <= 0.0) {
        empty_.push_back(robot);
        if (!std::exchange(has_warned_, true)) {
            log().warn(
                "t = {:.4f} s: the battery of robot #{} of category '{}' is empty: the robot is switched off, and "
                "so is every other one whose battery empties later",
                world.time_s(), world.robots.id[robot], world.categories[world.robots.category[robot]].name);
        }
    }
}

}  // namespace pogosim
