#include "sim/check_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "base/log.hpp"
#include "config/places.hpp"

namespace pogosim {

namespace {

struct Motion {
    ObjectSetting setting;
    char const* verb;
    double speed;            // as it is set
    double per_speed;        // largest speed of the robot for each unit of it
    double most;             // in one step
    char const* unit;        // of what is done in a step
    char const* reason;      // of `most`
    char const* speed_unit;  // of `speed`
};

/// Rounded down to three digits.
double rounded_down(double value) {
    double const digit = std::pow(10.0, std::floor(std::log10(value)) - 2.0);
    return std::floor(value / digit) * digit;
}

std::string text(double value) {
    return value >= 100.0 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

void check(Scenario const& scenario, ObjectConfig const& object, Motion const& motion, double time_step_s) {
    double const in_a_step = motion.per_speed * motion.speed * time_step_s;
    if (in_a_step <= motion.most) {
        return;
    }
    throw ConfigError(
        fmt::format("{}: at {} {}, robots {} up to {} {} in a time_step of {} s, more than the {} {} that {}. Use at "
                    "most {} {}, or a time_step of at most {} s",
                    place_of(scenario, object, motion.setting), text(motion.speed), motion.speed_unit, motion.verb,
                    text(in_a_step), motion.unit, text(time_step_s), text(motion.most), motion.unit, motion.reason,
                    text(rounded_down(motion.most / motion.per_speed / time_step_s)), motion.speed_unit,
                    text(rounded_down(motion.most / motion.per_speed / motion.speed))));
}

bool drives(ObjectConfig const& object) {
    return object.nb > 0 && object.spec.body && object.spec.robot && object.spec.robot->model.has_motors();
}

/// 0 for an object that does not drive.
double top_speed_mm_s(ObjectConfig const& object) {
    return drives(object) ? static_cast<double>(object.spec.robot->max_linear_speed_mm_s) : 0.0;
}

}  // namespace

void warn_of_ambiguous_rows(Scenario const& scenario, World const& world) {
    OutputConfig const& output = scenario.output;
    double const period_s = output.save_data_period_s;
    bool const has_steps = output.enable_data_logging && period_s > 0.0 && period_s <= scenario.simulation_time_s;
    auto const is_coordinate = [](std::string const& column) { return column == "x" || column == "y"; };
    bool const has_positions = !output.fields || std::ranges::any_of(*output.fields, is_coordinate);
    if (!world.periodic || !has_steps || !has_positions) {
        return;
    }
    auto const fastest = std::ranges::max_element(scenario.objects, {}, top_speed_mm_s);
    Vec2 const size_mm = world.arena.bounds.size();
    double const half_mm = 0.5 * static_cast<double>(std::min(size_mm.x, size_mm.y));
    if (fastest == scenario.objects.end() || top_speed_mm_s(*fastest) * period_s <= half_mm) {
        return;
    }
    log().warn(
        "{}: within {} s, '{}' can cross half of the periodic arena ({} mm) at their {} mm/s (max_linear_speed): the "
        "shortest way between two rows need not be theirs, and speeds and displacements from the data file may be "
        "wrong. Use less than {} s",
        place_of(scenario, Setting::save_data_period), text(period_s), fastest->category, text(half_mm),
        text(top_speed_mm_s(*fastest)), text(rounded_down(half_mm / top_speed_mm_s(*fastest))));
}

void warn_of_rounded_speeds(Scenario const& scenario, World const& world) {
    constexpr double most = 0.01;  // of a speed
    float const farthest_mm = std::max(world.arena.bounds.max.x, world.arena.bounds.max.y);
    double const unit_mm = static_cast<double>(farthest_mm - std::nextafter(farthest_mm, 0.0F));
    double const unit_mm_s = unit_mm / world.time_step_s;
    for (ObjectConfig const& object : scenario.objects) {
        double const speed_mm_s = top_speed_mm_s(object);
        if (speed_mm_s > 0.0 && unit_mm_s > most * speed_mm_s) {
            log().warn(
                "time_step: in an arena of {} mm, positions are rounded to {} mm, so that in steps of {} s all speeds "
                "are rounded to multiples of {} mm/s; '{}' drive at up to {} mm/s (max_linear_speed). Use a longer "
                "time_step, or a smaller arena",
                text(static_cast<double>(farthest_mm)), text(unit_mm), text(world.time_step_s), text(unit_mm_s),
                object.category, text(speed_mm_s));
            return;
        }
    }
}

void check_motion(Scenario const& scenario, MotionLimits const& limits, double time_step_s) {
    char const* const can_simulate = "can be simulated";
    char const* const can_move = limits.is_of_membranes ? "a membrane can hold back" : can_simulate;
    for (ObjectConfig const& object : scenario.objects) {
        if (!drives(object)) {
            continue;
        }
        RobotSpec const& robot = *object.spec.robot;
        check(scenario, object,
              {ObjectSetting::linear_speed, "move", robot.max_linear_speed_mm_s, 1.0, limits.motion_mm, "mm", can_move,
               "mm/s"},
              time_step_s);
        double fastest_turn = 0.0;  // 4 with two wheels at full power against each other
        for (Drive const& drive : robot.model.drives) {
            fastest_turn += std::abs(static_cast<double>(drive.angular));
        }
        check(scenario, object,
              {ObjectSetting::angular_speed, "turn", robot.max_angular_speed_rad_s, fastest_turn, limits.turn_rad,
               "rad", can_simulate, "rad/s"},
              time_step_s);
    }
}

}  // namespace pogosim
