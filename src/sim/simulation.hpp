// A whole run: a world, the stages that change it, and the recorder.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "comms/ir_channel.hpp"
#include "config/scenario.hpp"
#include "light/lighting.hpp"
#include "physics/physics_engine.hpp"
#include "robot/programs.hpp"
#include "robot/user_guard.hpp"
#include "sim/parameters.hpp"
#include "sim/recorder.hpp"
#include "sim/stage_clock.hpp"
#include "world/world.hpp"

namespace pogosim {

struct RunOptions {
    bool progress_bar = false;
    bool measure_stages = false;  // for benchmarks
    bool strict = false;          // unread parameters are an error
};

class Simulation {
public:
    /// Builds the world. Throws ConfigError.
    Simulation(Scenario scenario, RunOptions options);
    ~Simulation();

    Simulation(Simulation const&) = delete;
    Simulation& operator=(Simulation const&) = delete;

    /// From the first main() to the last callback: runs until the simulated time is over, the program or the user ends
    /// it, or user code fails. Errors of user code are logged and set the exit code. Throws OutputError and, if strict,
    /// ConfigError at the end of a run in which a parameter was not read.
    ExitCode run();

    // The same in parts, for tests and benchmarks. start() once, then steps, then finish().
    std::optional<UserFailure> start();
    std::optional<UserFailure> step();
    void finish();

    World const& world() const { return world_; }
    IrChannel const& channel() const { return channel_; }
    Programs const& programs() const { return programs_; }
    StageClock const& stages() const { return stages_; }
    std::int64_t step_count() const;  // steps of the whole run

private:
    std::optional<UserFailure> run_steps();
    void fit_time_step();
    bool is_over() const;
    void report(UserFailure const& failure) const;
    void report_unread_parameters() const;

    Scenario scenario_;
    RunOptions options_;
    std::uint32_t seed_;
    World world_;
    UserParameters parameters_;
    RunServices services_;
    Programs programs_;
    Lighting lighting_;
    IrChannel channel_;
    std::unique_ptr<PhysicsEngine> physics_;
    Recorder recorder_;
    StageClock stages_;
};

}  // namespace pogosim
