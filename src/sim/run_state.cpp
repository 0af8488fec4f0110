// --save-state and --from-state: the state of a run for another process.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/escaped.hpp"
#include "base/log.hpp"
#include "base/rounded_time.hpp"
#include "physics/physics_engine.hpp"
#include "sim/interrupt.hpp"
#include "sim/simulation.hpp"
#include "sim/state_file.hpp"
#include "world/saved_world.hpp"

namespace pogosim {

namespace {

constexpr double kPatienceS = 5.0;  // of wall-clock time, in addition

}  // namespace

std::string Simulation::why_never_for_process() const {
    if (observer_) {
        return "its firmware is profiled, or looked at by gdb";
    }
    if (!physics_->copy()) {
        return fmt::format("its physics engine ({}) cannot be saved", physics_engine_behind(scenario_.physics_engine));
    }
    for (auto const& brain : brains_) {
        if (std::string reason = brain->why_never_for_process(); !reason.empty()) {
            return reason;
        }
    }
    return "";
}

std::string Simulation::why_not_now_for_process() const {
    for (auto const& brain : brains_) {
        if (std::string reason = brain->why_not_now_for_process(); !reason.empty()) {
            return reason;
        }
    }
    return "";
}

void Simulation::append_for_process(StateWriter& state) {
    Thread const thread(*this);
    append_world(world_, state);
    physics_->append_state(state);
    state(broken_links_, touches_);
    for (auto const& brain : brains_) {
        brain->append_for_process(state);
    }
    recorder_.append_state(state);
}

StateFile Simulation::kind_of_state() const {
    return {.identity = identity_,
            .seed = seed_,
            .time_s = world_.time_s(),
            .hash = hash(),
            .has_ended = services_.stop_requested,
            .rows = recorder_.all_rows()};
}

void Simulation::check_state(StateFile const& saved) const {
    check_identity(saved, identity_of(controllers_.image(), scenario_, world_, brains_, inputs_));
    std::string const time = fmt::format("--from-state: '{}' is of t = {} s", saved.file.string(), saved.time_s);
    // A run that was killed at its very end has nothing left to do.
    bool const may_be_over = options_.save_state_every_s.has_value();
    if (saved.has_ended && !may_be_over) {
        throw ConfigError(time + ", when its program ended the run: there is nothing to go on with");
    }
    double const most_s = scenario_.simulation_time_s + (may_be_over ? world_.time_step_s : 0.0);
    if (saved.time_s >= most_s) {
        throw ConfigError(fmt::format("{}, and simulation_time is {} s: set a longer one (--set simulation_time=)",
                                      time, scenario_.simulation_time_s));
    }
    if (options_.save_state_at_s && *options_.save_state_at_s < saved.time_s) {
        throw ConfigError(fmt::format("{}: --at {} is before that", time, *options_.save_state_at_s));
    }
}

/// What is known before any robot runs.
void Simulation::check_states() {
    if (options_.from_state) {
        check_state(*options_.from_state);
    }
    if (options_.save_state.empty()) {
        return;
    }
    identity_ = identity_of(controllers_.image(), scenario_, world_, brains_, inputs_);
    if (options_.save_state_at_s && *options_.save_state_at_s > scenario_.simulation_time_s) {
        throw ConfigError(fmt::format("--at {}: the run ends at {} s (simulation_time)", *options_.save_state_at_s,
                                      scenario_.simulation_time_s));
    }
    if (std::string const reason = why_never_for_process(); !reason.empty()) {
        go_on_unsaved(reason);
        return;
    }
    saved_at_ = std::chrono::steady_clock::now();
    state_output_ = std::make_unique<StateOutput>(options_.save_state);
}

/// After the start of the programs: what they keep can be known by now, before the end of a long run.
void Simulation::check_saving() {
    if (state_output_ && why_not_now_for_process().empty()) {
        try {
            for (auto const& brain : brains_) {
                StateWriter trial;
                brain->append_for_process(trial);
            }
        } catch (ConfigError const& error) {
            go_on_unsaved(error.what());
        }
    }
}

void Simulation::go_on_unsaved(std::string const& reason) {
    std::string const message = fmt::format("--save-state: the state of this run cannot be saved: {}", reason);
    if (!options_.save_state_every_s) {
        throw ConfigError(message);
    }
    log().warn("{}; it goes on without", escaped(message));
    state_output_.reset();
}

/// After start(): all of the run becomes what it was, but for what belongs to this process.
void Simulation::go_on_from(StateFile const& saved) {
    try {
        StateReader state(saved.state);
        take_world(world_, state);
        physics_->take_state(state);
        state(broken_links_, touches_);
        for (auto const& brain : brains_) {
            brain->take_from_process(state);
        }
        recorder_.take_state(state);
    } catch (ForeignState const& foreign) {
        throw ConfigError(
            fmt::format("--from-state: '{}' does not fit this run: {}", saved.file.string(), foreign.what()));
    }
    // The map as it was, also where a lamp has moved on since.
    std::vector<std::int16_t> const levels = world_.light.level;
    lighting_.forget_map();
    lighting_.update(world_);
    world_.light.level = levels;
    lighting_.forget_map();
    services_.are_lines_hidden = false;
    services_.stop_requested = saved.has_ended;
    began_s_ = world_.time_s();
    if (observed_motions_) {
        observed_motions_->update(world_);
    }
    if (pictures_) {
        pictures_->go_on();
    }
    if (hash() != saved.hash) {
        throw ConfigError(
            fmt::format("--from-state: '{}' does not give the run that it is of: the state of t = {} s "
                        "has the hash {:016x}, and what came of it {:016x}",
                        saved.file.string(), saved.time_s, saved.hash, hash()));
    }
    log().info("goes on from '{}' at t = {} s", escaped(saved.file.string()), rounded_to_ns(began_s_));
}

/// The rows before it are on the disk before it is. Throws OutputError.
void Simulation::write_state() {
    bool const is_last = !options_.save_state_every_s || is_over();
    recorder_.save_now();
    saved_at_ = std::chrono::steady_clock::now();
    is_save_late_ = false;
    try {
        StateWriter state;
        append_for_process(state);
        state_output_->write(kind_of_state(), state.bytes());
        is_state_unwritten_ = false;
    } catch (ConfigError const& error) {
        if (options_.save_state_every_s) {
            go_on_unsaved(error.what());
        } else {
            lost_state_ = error.what();
        }
        return;
    } catch (OutputError const& error) {
        if (!options_.save_state_every_s) {
            throw;
        }
        if (!std::exchange(is_state_unwritten_, true)) {
            log().warn("{}; this is tried again, and not told again until it has worked", escaped(error.what()));
        }
        return;
    }
    constexpr auto kSaved = "the state of t = {} s is in '{}': go on with --from-state";
    if (is_last) {
        log().info(kSaved, rounded_to_ns(world_.time_s()), escaped(options_.save_state));
        state_output_.reset();
    } else {
        log().debug(kSaved, rounded_to_ns(world_.time_s()), escaped(options_.save_state));
    }
}

bool Simulation::is_state_due() const {
    if (!state_output_) {
        return false;
    }
    if (options_.save_state_every_s) {
        return std::chrono::steady_clock::now() - saved_at_ >=
               std::chrono::duration<double>(*options_.save_state_every_s);
    }
    return options_.save_state_at_s &&
           world_.time_s() >= *options_.save_state_at_s - kWholeTolerance * world_.time_step_s;
}

/// Where a robot waits in the middle of its program, a later step is taken.
void Simulation::save_state_if_due() {
    if (!is_state_due()) {
        return;
    }
    if (why_not_now_for_process().empty()) {
        write_state();
    } else {
        tell_of_late_state();
    }
}

/// That robots wait for some steps is usual; where a state is due again, they may wait at all times.
void Simulation::tell_of_late_state() {
    std::string const reason = why_not_now_for_process();
    if (!options_.save_state_every_s) {
        if (!std::exchange(is_save_late_, true)) {
            log().info("--save-state: at t = {} s, {}: the state is that of the first step without",
                       rounded_to_ns(world_.time_s()), reason);
        }
        return;
    }
    std::chrono::duration<double> const since = std::chrono::steady_clock::now() - saved_at_;
    if (since.count() >= 2.0 * *options_.save_state_every_s + kPatienceS && !std::exchange(is_save_late_, true)) {
        log().warn("--save-state: no state could be saved for {:.0f} s: {}", since.count(), reason);
    }
}

void Simulation::save_state_at_end() {
    if (!state_output_ || restart()) {
        return;
    }
    std::string const reason = why_not_now_for_process();
    if (reason.empty()) {
        write_state();
        return;
    }
    std::string const message = fmt::format("at t = {} s, {}", rounded_to_ns(world_.time_s()), reason);
    if (!options_.save_state_every_s) {
        lost_state_ = message;
    } else if (interrupted()) {
        log().warn("--save-state: {}: the state in '{}' is an earlier one, or there is none", message,
                   escaped(options_.save_state));
    }
}

}  // namespace pogosim
