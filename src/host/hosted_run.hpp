// A run inside another process: the C++ behind pogosim/host.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/fair_mutex.hpp"
#include "base/log.hpp"
#include "pogosim/host.h"
#include "process/program_image.hpp"
#include "sim/simulation.hpp"

namespace pogosim {

/// A program that is loaded, and unloaded again behind the run. What constructors and destructors of its static objects
/// do is done by no robot, although one of another run may have run last in this thread.
class HostedProgram {
public:
    explicit HostedProgram(std::filesystem::path const& file);
    ~HostedProgram();
    HostedProgram(HostedProgram const&) = delete;
    HostedProgram& operator=(HostedProgram const&) = delete;

    ProgramImage const& image() const { return *image_; }

private:
    std::unique_ptr<ProgramImage const> image_;
};

}  // namespace pogosim

/// As declared in pogosim/host.h. Functions throw what the functions there turn into a status. Functions of host.h hold
/// `in_use` while they look at a run or change it; step() passes it on between two steps.
struct pogosim_run {
public:
    explicit pogosim_run(pogosim_run_options const& options);
    ~pogosim_run();
    pogosim_run(pogosim_run const&) = delete;
    pogosim_run& operator=(pogosim_run const&) = delete;

    /// Returns the steps made. Throws RunFailure.
    std::int64_t step(std::int64_t steps, double budget_s);
    void end();
    bool is_over() const { return has_ended_ || has_failed_ || simulation_->is_over(); }
    bool has_failed() const { return has_failed_; }
    bool has_ended() const { return has_ended_ || has_failed_; }

    pogosim::Simulation& simulation() { return *simulation_; }
    pogosim::Simulation const& simulation() const { return *simulation_; }

    std::string const& categories() const { return categories_; }
    std::string const& columns() const { return columns_; }
    bool has_messages() const { return !lines_.empty(); }
    std::string const& take_messages();

    std::uint64_t const number;  // no other run of this process has it
    pogosim::FairMutex mutable in_use;
    std::string mutable metadata;  // empty until it is asked for

private:
    std::int64_t make_steps(std::int64_t steps, double budget_s);
    void must_succeed(pogosim::Outcome const& outcome);
    pogosim::ExitCode conclude(pogosim::Outcome const& outcome);

    std::vector<pogosim::LogLine> lines_;
    std::string messages_;
    std::shared_ptr<pogosim::Log> log_;
    std::optional<pogosim::HostedProgram> program_;
    std::unique_ptr<pogosim::Simulation> simulation_;
    std::string categories_;
    std::string columns_;
    bool has_ended_ = false;
    bool has_failed_ = false;
};

namespace pogosim {

/// The user's program has failed: the message, and what an executable would exit with.
struct RunFailure : std::runtime_error {
    RunFailure(std::string const& message, ExitCode exit_code) : std::runtime_error(message), code(exit_code) {}
    ExitCode code;
};

/// The number of this name, as of pogosim_run_number(); nothing if there is none.
std::optional<double> number_of(pogosim_run const& run, std::string_view name);

/// The array of this name; nothing if there is none.
std::optional<pogosim_array> array_of(Simulation const& simulation, std::string_view name);

/// How many bodies membranes are made of.
std::size_t part_count(World const& world);

/// An array of a category that this process drives. Throws ConfigError if there is none.
pogosim_array brain_array_of(pogosim_run& run, std::string_view category, std::string_view name);

/// Does what pogosim_run_take_turn() does; the caller holds the run's `in_use`.
void take_turn(pogosim_run& run, pogosim_turn& turn, double budget_s);

/// Give a run its array of an exchange before a turn, and take it afterwards. `index`: of the run in the host's memory.
/// The caller holds the run's `in_use`. Throw ConfigError if there is no such array, or it has another size.
void give_array(pogosim_run& run, std::size_t index, pogosim_exchange const& exchange);
void take_array(pogosim_run& run, std::size_t index, pogosim_exchange const& exchange);

/// What pogosim_run_light_levels() gives. `levels` has a place for each robot.
void read_light_levels(World const& world, double* levels);

/// The array of a column of the data file.
std::optional<pogosim_array> column_array_of(SavedColumns const& saved, std::string_view name);

}  // namespace pogosim
