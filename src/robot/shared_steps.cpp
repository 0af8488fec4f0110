#include "robot/shared_steps.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/log.hpp"

namespace pogosim {

namespace {

constexpr std::uint32_t kLeastRobots = 64;  // of a part that one worker takes

}  // namespace

SharedSteps::SharedSteps(Controllers& controllers, CrashHandler& handler, std::uint32_t workers)
    : controllers_(controllers), variables_(controllers.configured_variables()) {
    for (std::uint32_t worker = 1; worker < workers; ++worker) {
        handlers_.push_back(std::make_unique<WorkerCrashHandler>(handler));
    }
}

std::optional<UserFailure> SharedSteps::run_step(WorkerPool& workers) {
    if (auto failure = call_user_code([this] { controllers_.begin_step(); })) {
        return failure;
    }
    if (!is_over_ && controllers_.gave_user_data()) {
        is_over_ = true;
        log().info(
            "robots take their steps one after the other from now on: callback_global_step has had USERDATA of "
            "robots, and may have put the same address into several");
    }
    if (is_over_) {
        return run_one_after_the_other();
    }
    variables_.remember();
    callbacks_ = Controllers::callbacks_of_thread();
    first_failed_ = kNone;
    auto const count = static_cast<std::uint32_t>(controllers_.all().size());
    parts_.resize(workers.range_count(count, kLeastRobots));
    workers.run_ranges(count, kLeastRobots, [this](WorkRange range) { run_part(range); });
    Controllers::set_callbacks_of_thread(callbacks_);
    for (Part& part : parts_) {
        if (auto failure = join(part)) {
            return failure;
        }
    }
    controllers_.end_step();
    return look_at_variables();
}

std::optional<UserFailure> SharedSteps::run_one_after_the_other() {
    return call_user_code([this] {
        controllers_.run_robots(0, static_cast<std::uint32_t>(controllers_.all().size()));
        controllers_.end_step();
    });
}

void SharedSteps::run_part(WorkRange range) {
    Part& part = parts_[range.part];
    part.outbox.clear();
    part.failure.reset();
    part.callbacks = callbacks_;
    if (range.part > first_failed_) {
        return;  // the run ends before these robots
    }
    if (range.worker > 0) {
        handlers_[range.worker - 1]->enter();
    }
    context.outbox = &part.outbox;
    Controllers::set_callbacks_of_thread(callbacks_);
    part.failure = call_user_code([&] { controllers_.run_robots(range.first, range.last); });
    context.outbox = nullptr;
    part.callbacks = Controllers::callbacks_of_thread();
    if (part.failure) {
        part.failed = running_robot();
        std::uint32_t first = first_failed_;
        while (range.part < first && !first_failed_.compare_exchange_weak(first, range.part)) {
        }
    }
}

/// After a failure, the parts that follow have not run.
std::optional<UserFailure> SharedSteps::join(Part& part) {
    controllers_.take_over(part.outbox);
    if (part.callbacks != callbacks_) {
        Controllers::set_callbacks_of_thread(part.callbacks);
    }
    if (!part.failure) {
        return std::nullopt;
    }
    set_running_robot(part.failed);
    if (std::ranges::any_of(handlers_, [](auto const& handler) { return handler->was_left_by_force(); })) {
        begin_rescue_of_run(*part.failure);
    }
    return part.failure;
}

std::optional<UserFailure> SharedSteps::look_at_variables() {
    std::string const changed = variables_.changed();
    if (changed.empty()) {
        return std::nullopt;
    }
    context.is_system = true;  // the robot that changed it is unknown
    return UserFailure{
        fmt::format("a robot has changed the variable that is set from the parameter '{}', which all robots "
                    "share, while others ran on other threads: give each robot its own in USERDATA, or "
                    "take threads: 1",
                    changed)};
}

}  // namespace pogosim
