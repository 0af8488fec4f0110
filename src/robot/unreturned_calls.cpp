// A warning about functions of robots that do not return: an endless loop in user_step, most often, as programs for the
// robots' SDK have it in main(). Each wait in it gives control back to the simulator, so the run goes on without ticks.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/log.hpp"
#include "device/clock.hpp"
#include "process/backtrace.hpp"
#include "robot/controllers.hpp"

namespace pogosim {

namespace {

constexpr std::int64_t kUsPerS = 1000000;
// During the run, if half of a category is in such a call or more: how long it has lasted, and how often it has waited.
// An endless loop looks around again and again; a long dance of LEDs or motors, which will return, pauses between them.
constexpr std::int64_t kLongUs = 60 * kUsPerS;
constexpr int kWaitsOfLongCall = 1000;
constexpr std::int64_t kLookPeriodUs = 10 * kUsPerS;
// At the end of the run, for each robot: how long its call must last at least, in time, as a part of the run, and
// compared with the usual in its category. A robot that only waits for something may be in one call for long, too.
constexpr std::int64_t kLongAtEndUs = 10 * kUsPerS;
constexpr std::int64_t kPartOfRunAtEnd = 4;
constexpr std::int64_t kTimesTheUsual = 10;
constexpr int kWaitsAtEnd = 5;  // fewer may be a few long sleeps, one after the other

/// Robots of one category that have been in a call for long.
struct Unreturned {
    std::uint32_t alive = 0;
    std::uint32_t count = 0;
    std::uint32_t first = kNone;       // the robot whose call has lasted longest
    std::int64_t longest_call_us = 0;  // the longest call that has returned
};

/// What the stack of a waiting robot tells.
struct Wait {
    Controller const* robot = nullptr;
    void const* program = nullptr;  // any place in its code
    char const* function = "";      // of the program, that the main loop has called
    void const* place = nullptr;    // where it waits
    void const* caller = nullptr;   // where the function at `place` was called
};

void look_at_stack(void* of_wait) {
    Wait& wait = *static_cast<Wait*>(of_wait);
    LoopGlobals const& loop = wait.robot->loop;
    auto const is_on_stack = [](auto* function) {
        return function != nullptr && is_being_called(reinterpret_cast<void const*>(function));
    };
    wait.function = wait.robot->waits_in == Phase::user_step && is_on_stack(loop.receive) ? "msg_rx_fn"
                    : wait.robot->waits_in == Phase::user_step && is_on_stack(loop.send)
                        ? "msg_tx_fn"
                        : name_of(wait.robot->waits_in);
    void const* const program = object_of(wait.program);
    wait.place = place_in_program(program);
    wait.caller = place_in_program(program, nullptr, /*callees=*/1);
}

/// What does not happen while the function does not return.
std::string consequences(Controller const& robot, std::uint32_t ticks, std::string_view function) {
    std::vector<std::string> parts;
    if (function == "user_init") {
        return "user_step is not called";
    }
    parts.emplace_back(ticks == 0 ? "pogobot_ticks stays 0" : "pogobot_ticks stays as it is");
    if (function != "user_step") {
        parts.emplace_back("user_step is not called again");
    }
    if (robot.loop.send != nullptr && function == "user_step") {
        parts.emplace_back("msg_tx_fn sends nothing");
    }
    if (robot.loop.receive != nullptr && function != "msg_rx_fn") {
        parts.emplace_back("msg_rx_fn gets no message");
    }
    return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

void Controllers::warn_of_unreturned_calls_if_due() {
    if (step_us_ < next_look_us_) {
        return;
    }
    next_look_us_ = std::max(step_us_ + kLookPeriodUs, kLongUs);
    if (step_us_ >= kLongUs) {
        warn_of_unreturned_calls(kLongUs, /*most=*/true);
    }
}

void Controllers::warn_of_unreturned_calls_at_end() {
    warn_of_unreturned_calls(std::min(kLongAtEndUs, time_us(world_) / kPartOfRunAtEnd), /*most=*/false);
}

/// `least_us`: shorter calls do not count. `most`: warns only about categories half of whose robots are in such a call,
/// or more. (Rarely all of them: a robot that hears no other robot is not called back with messages.)
void Controllers::warn_of_unreturned_calls(std::int64_t least_us, bool most) {
    if (!has_waited_ || image_.is_for_sdk) {
        return;
    }
    is_warned_.resize(world_.categories.size());
    std::vector<Unreturned> categories(world_.categories.size());
    std::int64_t const now_us = time_us(world_);
    for (Controller const& self : controllers_) {
        Unreturned& category = categories[world_.robots.category[&self - controllers_.data()]];
        category.longest_call_us = std::max(category.longest_call_us, self.longest_call_us);
    }
    for (std::uint32_t i = 0; i < controllers_.size(); ++i) {
        if (!is_alive(world_, i)) {
            continue;
        }
        Controller const& self = controllers_[i];
        Unreturned& category = categories[world_.robots.category[i]];
        ++category.alive;
        std::int64_t const limit_us = std::max(least_us, kTimesTheUsual * category.longest_call_us);
        bool const is_loop = self.fiber != nullptr && self.waits >= (most ? kWaitsOfLongCall : kWaitsAtEnd);
        if (is_loop && now_us - self.call_began_us >= limit_us) {
            ++category.count;
            if (category.first == kNone || self.call_began_us < controllers_[category.first].call_began_us) {
                category.first = i;
            }
        }
    }
    for (std::size_t i = 0; i < categories.size(); ++i) {
        Unreturned const& category = categories[i];
        if (category.count > 0 && !is_warned_[i] && (!most || 2 * category.count >= category.alive)) {
            is_warned_[i] = true;
            warn_of_unreturned_call(category.first, category.count, category.alive);
        }
    }
}

/// `robot`: one of `count` of the `alive` robots of its category.
void Controllers::warn_of_unreturned_call(std::uint32_t robot, std::uint32_t count, std::uint32_t alive) const {
    Controller const& self = controllers_[robot];
    Wait wait{.robot = &self, .program = reinterpret_cast<void const*>(image_.main)};
    visit(*self.fiber, look_at_stack, &wait);
    std::string place = place_in_source(image_, wait.place);
    if (place.ends_with("in sleep()") || place.ends_with("in usleep()")) {  // our wrappers, linked into the program
        place = place_in_source(image_, wait.caller);
    }
    std::string const robots = count < alive ? fmt::format("{} of {} robots", count, alive)
                               : alive == 1  ? "its robot"
                                             : fmt::format("all {} robots", alive);
    log().warn(
        "category '{}': {} of {} has not returned since t = {:.4g} s (robot #{} waits{}{}): {} until it returns. Let "
        "it return: the main loop calls user_step at each tick. An endless loop as on the robot belongs in main(), "
        "with pogobot.h (docs/porting.md)",
        world_.categories[world_.robots.category[robot]].name, wait.function, robots,
        static_cast<double>(self.call_began_us) / static_cast<double>(kUsPerS), world_.robots.id[robot],
        place.empty() ? "" : " ", place, consequences(self, ticks(robot), wait.function));
}

}  // namespace pogosim
