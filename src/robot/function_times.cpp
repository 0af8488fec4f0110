#include "robot/function_times.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include "base/escaped.hpp"
#include "base/log.hpp"
#include "base/nearest_name.hpp"
#include "device/clock.hpp"
#include "robot/context.hpp"
#include "robot/waiting.hpp"

namespace pogosim {

namespace {

constexpr std::string_view kMainLoop = "pogo_main_loop_step";

std::uintptr_t address_of(void (*function)()) {
    return reinterpret_cast<std::uintptr_t>(function);
}

/// The clock of the running robot goes on, but for what it has shown in loops that wait by it; so does the world. After
/// it, nothing that belongs to this thread may be used.
void take_time_beside_polls(double us) {
    Controller& self = *context.controller;
    double const polled_us = std::exchange(self.polled_us, 0.0);
    take_time(*context.world, context.robot, std::max(0.0, us - polled_us), self.rest_us);
    wait_for_clock();
}

}  // namespace

FunctionTimes::FunctionTimes(std::string const& category, RobotSpec const& spec, ProgramImage const& image)
    : category_(escaped(category)), load_address_(image.load_address), functions_(image.functions()) {
    if (functions_.empty()) {
        log().warn("objects.{}.function_costs have no effect: the program does not name its functions (strip, -s)",
                   category_);
        return;
    }
    std::vector<std::string> names;
    std::ranges::transform(functions_, std::back_inserter(names), &ProgramFunction::name);
    std::vector<std::string> unknown;
    for (FunctionCost const& cost : spec.function_costs) {
        double const us = spec.model.processor.us_of(cost.cycles) + cost.library_us;
        if (cost.function == kMainLoop) {
            main_loop_us_ = us;
        } else if (!add(cost.function, us, names)) {
            unknown.push_back(cost.function);
        }
    }
    if (!unknown.empty()) {
        std::string const more = unknown.size() > 1 ? fmt::format(", nor {} more", unknown.size() - 1) : "";
        log().warn("objects.{}.function_costs: the program has no function '{}'{}{}", category_,
                   escaped(unknown.front()), more, did_you_mean(unknown.front(), names));
    }
}

/// False: there is no function of this name. If there are several, static in their files, all take this time. `names`:
/// of all functions, in their order.
bool FunctionTimes::add(std::string const& name, double us, std::span<std::string const> names) {
    std::size_t const before = times_.size();
    for (std::size_t i = 0; i < functions_.size(); ++i) {
        if (functions_[i].symbol == name || names[i] == name) {
            times_.push_back({.function = load_address_ + functions_[i].address, .us = us});
        }
    }
    return times_.size() > before;
}

double FunctionTimes::of(void (*function)()) const {
    auto const found = std::ranges::find(times_, address_of(function), &Time::function);
    if (found != times_.end()) {
        return found->us;
    }
    note_without_costs(address_of(function));
    return 0.0;
}

void FunctionTimes::note_without_costs(std::uintptr_t function) const {
    for (std::atomic<std::uintptr_t>& noted : without_costs_) {
        std::uintptr_t expected = 0;
        if (noted == function || noted.compare_exchange_strong(expected, function) || expected == function) {
            return;
        }
    }
}

void FunctionTimes::tell_at_end() const {
    std::vector<std::string> names;
    for (std::uintptr_t const address : without_costs_) {
        auto const found = std::ranges::find(functions_, address - load_address_, &ProgramFunction::address);
        if (address != 0 && found != functions_.end()) {  // else it is the library's, as that of a wall
            names.push_back(escaped(found->name()));
        }
    }
    std::ranges::sort(names);
    if (!names.empty()) {
        log().warn(
            "objects.{}.function_costs say nothing of {}, which the main loop has called in no time; measure where "
            "they are called, too: pogosim profile --costs FILE",
            category_, fmt::join(names, ", "));
    }
}

void take_time_of(void (*function)()) {
    Controller const* const self = context.controller;
    if (self != nullptr && self->times != nullptr && function != nullptr) [[unlikely]] {
        take_time_beside_polls(self->times->of(function));
    }
}

void take_time_of_tick(void (*step)()) {
    Controller const* const self = context.controller;
    if (self != nullptr && self->times != nullptr) [[unlikely]] {
        double const step_us = step == nullptr ? 0.0 : self->times->of(step);
        take_time_beside_polls(self->times->main_loop_us() + step_us);
    }
}

}  // namespace pogosim
