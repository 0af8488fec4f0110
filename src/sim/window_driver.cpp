#include "sim/window_driver.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>
#include <variant>

#include "base/error.hpp"
#include "base/escaped.hpp"
#include "base/log.hpp"
#include "pogosim/version.h"
#include "process/crash_handler.hpp"
#include "sim/pictures.hpp"
#include "sim/simulation.hpp"

namespace pogosim {

namespace {

constexpr std::size_t kMostTrailBytes = std::size_t{64} << 20;  // 512 places for each of 10 000 robots
constexpr std::chrono::milliseconds kLookPeriod{50};            // for Ctrl-C, while nothing happens

template <class... Handlers>
struct Overloaded : Handlers... {
    using Handlers::operator()...;
};
template <class... Handlers>
Overloaded(Handlers...) -> Overloaded<Handlers...>;

}  // namespace

WindowDriver::WindowDriver(Simulation& simulation, WindowSetup const& setup)
    : simulation_(simulation),
      taker_(simulation.snapshots()),
      pacer_(setup.speed_up),
      paused_(setup.restored && setup.restored->paused),
      window_(std::make_unique<OpenWindow>(setup)),
      states_(setup.options.history_s),
      values_(simulation.world(), simulation.saved_columns()) {
    taker_.limit_trails(kMostTrailBytes);
    taker_.follow_trails();
    states_.keep_if_due(simulation);
    pause_when(setup.restored ? setup.restored->options.pause_when : setup.options.pause_when);
}

WindowDriver::~WindowDriver() = default;

std::optional<UserFailure> WindowDriver::wait_for_step() {
    while (is_open() && !is_over_ && !interrupted()) {
        if (auto failure = carry_out_commands()) {
            return failure;
        }
        show_if_wanted();
        note_window_end();
        auto const now = Pacer::Clock::now();
        World const& world = simulation_.world();
        bool const may_step = !paused_ || steps_asked_ > 0;
        auto const due = may_step && !paused_ ? pacer_.due(world.time_s(), world.time_step_s, now) : now;
        if (may_step && due <= now) {
            break;
        }
        simulation_.save_while_waiting();
        if (is_open()) {
            window_->exchange().wait_until(std::min(may_step ? due : now + kLookPeriod, now + kLookPeriod));
        }
    }
    return std::nullopt;
}

void WindowDriver::note_step() {
    if (!is_open()) {
        return;
    }
    steps_asked_ = std::max(steps_asked_ - 1, 0);
    pacer_.note_step(simulation_.world().time_s(), Pacer::Clock::now());
    simulation_.inspector().note_step();
    drag();
    taker_.follow_trails();
    states_.keep_if_due(simulation_);
    pause_if_true();
}

void WindowDriver::show_end() {
    shows_end_ = true;
    dragged_.reset();
    while (is_open() && !is_over_ && !interrupted()) {
        carry_out_commands();
        show_if_wanted();
        flush_logs_if_due();
        note_window_end();
        if (is_open()) {
            window_->exchange().wait_until(Pacer::Clock::now() + kLookPeriod);
        }
    }
}

std::optional<Restart> WindowDriver::restart() {
    if (is_open()) {
        while (auto const command = window_->exchange().take_command()) {
            if (auto const* const asked = std::get_if<Restart>(&*command)) {
                restart_ = *asked;
            }
        }
    }
    return restart_;
}

void WindowDriver::drag() {
    if (dragged_) {
        simulation_.move_object(dragged_->object, dragged_->centre_mm);
    }
}

void WindowDriver::note_window_end() {
    auto const end = window_->exchange().end();
    if (!end) {
        return;
    }
    if (*end == WindowEnd::closed || shows_end_) {
        is_over_ = true;
    } else if (*end == WindowEnd::display_lost) {
        log().warn("the display is gone at t = {:.4f} s; the run goes on without a window",
                   simulation_.world().time_s());
    } else {
        log().warn("the window failed at t = {:.4f} s: {}; the run goes on without it", simulation_.world().time_s(),
                   window_->exchange().error());
    }
    window_.reset();
    dragged_.reset();
    simulation_.stop_inspecting();
}

std::optional<UserFailure> WindowDriver::carry_out_commands() {
    while (auto const command = window_->exchange().take_command()) {
        if (auto failure = carry_out(*command)) {
            return failure;
        }
    }
    return std::nullopt;
}

std::optional<UserFailure> WindowDriver::carry_out(Command const& command) {
    std::optional<UserFailure> failure;
    bool const needs_the_run = std::holds_alternative<Pause>(command) || std::holds_alternative<StepOnce>(command) ||
                               std::holds_alternative<ClickRobot>(command) ||
                               std::holds_alternative<DragObject>(command) || std::holds_alternative<GoBack>(command);
    if (shows_end_ && needs_the_run) {
        return failure;
    }
    auto const pause = [this](bool on) {
        paused_ = on;
        why_paused_.clear();
        steps_asked_ = 0;
        pacer_.start_anew();
    };
    std::visit(Overloaded{[&](Pause const& asked) { pause(asked.on); },
                          [&](StepOnce const&) {
                              int const steps = paused_ ? steps_asked_ : 0;
                              pause(true);
                              steps_asked_ = steps + 1;
                          },
                          [&](SetSpeedUp const& asked) { pacer_.set_speed_up(asked.factor); },
                          [&](ClickRobot const& asked) { failure = simulation_.click(asked.robot); },
                          [&](DragObject const& asked) {
                              dragged_ = asked;
                              drag();
                          },
                          [&](DropObject const&) { dragged_.reset(); },
                          [&](GoBack const& asked) {
                              pause(true);
                              failure = go_back(asked.time_s);
                          },
                          [&](PauseWhen const& asked) { pause_when(asked.condition); },
                          [&](Restart const& asked) {
                              restart_ = asked;
                              is_over_ = true;
                          },
                          [&](Quit const&) {
                              is_over_ = true;
                              if (shows_end_) {
                                  return;
                              }
                              World const& world = simulation_.world();
                              log().info("ended at t = {:.4f} s of {:g} s by closing the window", world.time_s(),
                                         static_cast<double>(simulation_.step_count()) * world.time_step_s);
                          },
                          [&](Note const& note) { log().info("{}", note.text); }},
               command);
    return failure;
}

std::optional<UserFailure> WindowDriver::go_back(double time_s) {
    std::optional<UserFailure> failure;
    if (!states_.go_back(simulation_, time_s)) {
        return failure;
    }
    double const step_s = simulation_.world().time_step_s;
    auto const is_there = [&] { return simulation_.world().time_s() >= time_s - 0.5 * step_s; };
    while (!failure && !is_there() && !simulation_.is_over() && !window_->exchange().end_is_asked()) {
        failure = simulation_.step();
        simulation_.inspector().note_step();
        taker_.follow_trails();
    }
    if (failure || !is_there()) {
        return failure;  // the program has failed, or the run or its window has been ended on the way
    }
    true_of_ = condition_ ? condition_->first_robot(values_) : std::nullopt;
    log().info("went back to t = {:.4f} s", simulation_.world().time_s());
    return failure;
}

void WindowDriver::pause_when(std::string const& condition) {
    condition_.reset();
    wrong_condition_.clear();
    true_of_.reset();
    if (condition.empty()) {
        return;
    }
    try {
        condition_.emplace(condition, values_.names());
    } catch (ConfigError const& error) {
        wrong_condition_ = error.what();
        log().warn("pause_when: {}", escaped(wrong_condition_));
    }
}

void WindowDriver::pause_if_true() {
    if (!condition_) {
        return;
    }
    std::optional<std::size_t> const robot = condition_->first_robot(values_);
    bool const has_become = robot && !true_of_;
    true_of_ = robot;
    if (!has_become) {
        return;
    }
    paused_ = true;
    steps_asked_ = 0;
    std::string values;
    for (std::string const& name : condition_->names()) {
        values += fmt::format("{}{} = {:.6g}", values.empty() ? "" : ", ", name, values_.of(name)[*robot]);
    }
    why_paused_ = fmt::format("robot {}: {}", simulation_.world().robots.id[*robot], values);
    log().info("paused at t = {:.4f} s: {}", simulation_.world().time_s(), escaped(why_paused_));
}

void WindowDriver::show_if_wanted() {
    auto const request = window_->exchange().take_request();
    if (!request) {
        return;
    }
    if (request->parts.heard) {
        simulation_.keep_heard();
    }
    auto moment = std::make_shared<Moment>();
    moment->snapshot = taker_.take(request->parts);
    moment->status = {.paused = paused_,
                      .asked_speed_up = pacer_.speed_up(),
                      .speed_up = pacer_.reached(),
                      .too_slow = pacer_.is_too_slow(),
                      .is_over = shows_end_,
                      .touched = simulation_.is_touched(),
                      .earliest_s = states_.earliest_s(),
                      .why_no_way_back = states_.why_no_way_back(),
                      .why_paused = why_paused_,
                      .wrong_condition = wrong_condition_};
    if (request->robot) {
        moment->inspection = simulation_.inspector().inspect(*request->robot);
    }
    moment->recorded = simulation_.inspector().rows().take();
    window_->exchange().publish(std::move(moment));
}

WindowSetup window_setup(Scenario const& scenario, World const& world, std::string const& program_name) {
    WindowSetup setup;
    std::string const name = program_name.empty() ? "" : program_name + " - ";
    setup.title = fmt::format("{}Pogosim {}", name, POGOSIM_VERSION_STRING);
    setup.size = picture_size(scenario);
    setup.options = scenario.view;
    setup.duration_s = scenario.simulation_time_s;
    setup.time_step_s = world.time_step_s;
    setup.speed_up = scenario.view.gui_speed_up;
    return setup;
}

}  // namespace pogosim
