// A whole run: a world, the stages that change it, and what is written down of it.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "comms/ir_channel.hpp"
#include "config/scenario.hpp"
#include "light/lighting.hpp"
#include "physics/physics_engine.hpp"
#include "record/data_file.hpp"
#include "robot/programs.hpp"
#include "robot/user_guard.hpp"
#include "sim/parameters.hpp"
#include "sim/stage_clock.hpp"
#include "world/world.hpp"

namespace pogosim {

struct RunOptions {
    bool progress_bar = false;
    bool measure_stages = false;  // for benchmarks
};

class Simulation {
public:
    /// Builds the world. Throws ConfigError.
    Simulation(Scenario scenario, RunOptions options);
    ~Simulation();

    Simulation(Simulation const&) = delete;
    Simulation& operator=(Simulation const&) = delete;

    /// From the first main() to the last callback: runs until the simulated time is over, the program or the user ends
    /// it, or user code fails. Errors of user code are logged and give the exit code; OutputError is thrown.
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
    std::optional<UserFailure> open_data_file();
    void make_data_file();
    std::optional<UserFailure> record_if_due();
    std::optional<UserFailure> record_rows();
    void record_subparts(Object const& object);
    void fit_time_step();
    bool is_over() const;
    void report(UserFailure const& failure) const;
    std::string data_file_note() const;
    void report_losses() const;

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
    std::unique_ptr<DataFile> data_file_;
    std::vector<bool> category_is_recorded_;
    DataRow empty_row_;               // user columns of what runs no user code
    std::int64_t next_row_time_ = 0;  // in save periods
    StageClock stages_;
};

}  // namespace pogosim
