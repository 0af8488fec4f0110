#include "robot/function_times.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "base/escaped.hpp"
#include "base/log.hpp"
#include "base/nearest_name.hpp"
#include "device/clock.hpp"
#include "robot/context.hpp"

namespace pogosim {

namespace {

constexpr std::string_view kMainLoop = "pogo_main_loop_step";

std::uintptr_t address_of(void (*function)()) {
    return reinterpret_cast<std::uintptr_t>(function);
}

}  // namespace

FunctionTimes::FunctionTimes(std::string const& category, RobotSpec const& spec, ProgramImage const& image)
    : category_(category), load_address_(image.load_address), functions_(image.functions()) {
    for (FunctionCost const& cost : spec.function_costs) {
        double const us = spec.model.processor.us_of(cost.cycles) + cost.library_us;
        if (cost.function == kMainLoop) {
            main_loop_us_ = us;
            continue;
        }
        add(cost.function, us);
    }
}

/// Several functions of one name that are static in their files all take this time.
void FunctionTimes::add(std::string const& name, double us) {
    std::size_t const before = times_.size();
    for (ProgramFunction const& function : functions_) {
        if (function.name == name) {
            times_.push_back({.function = load_address_ + function.address, .us = us});
        }
    }
    if (times_.size() == before && !functions_.empty()) {
        std::vector<std::string> names;
        std::ranges::transform(functions_, std::back_inserter(names), &ProgramFunction::name);
        log().warn("objects.{}.function_costs: the program has no function '{}'{}", escaped(category_), escaped(name),
                   did_you_mean(name, names));
    }
}

double FunctionTimes::of(void (*function)()) const {
    auto const found = std::ranges::find(times_, address_of(function), &Time::function);
    if (found != times_.end()) {
        return found->us;
    }
    without_costs_ = address_of(function);
    return 0.0;
}

void FunctionTimes::tell_at_end() const {
    std::uintptr_t const address = without_costs_;
    if (address == 0) {
        return;
    }
    auto const found = std::ranges::find(functions_, address - load_address_, &ProgramFunction::address);
    log().warn(
        "objects.{}.function_costs say nothing of {}, which takes no time; measure them again: pogosim profile "
        "--costs FILE",
        escaped(category_), found == functions_.end() ? "a function that the main loop has called" : found->name);
}

void take_time_of(void (*function)()) {
    Controller* const self = context.controller;
    if (self != nullptr && self->times != nullptr && function != nullptr) [[unlikely]] {
        take_time(*context.world, context.robot, self->times->of(function), self->rest_us);
    }
}

void take_time_of_tick(void (*step)()) {
    Controller* const self = context.controller;
    if (self != nullptr && self->times != nullptr) [[unlikely]] {
        double const us = self->times->main_loop_us() + (step == nullptr ? 0.0 : self->times->of(step));
        take_time(*context.world, context.robot, us, self->rest_us);
    }
}

}  // namespace pogosim
