#include "host/hosted_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <filesystem>
#include <system_error>

#include "base/error.hpp"
#include "config/known_scenarios.hpp"
#include "config/scenario.hpp"
#include "firmware/firmware_program.hpp"
#include "lamps/lamp_types.hpp"
#include "robot/context.hpp"
#include "sim/files_of_run.hpp"

using namespace pogosim;

namespace {

/// Throws ConfigError if the run would write over the program.
void check_program_file(Scenario const& scenario, char const* program) {
    bool const is_input = std::ranges::any_of(scenario.object_files, [program](ObjectFile const& file) {
        std::error_code error;
        return std::filesystem::equivalent(file.path, program, error);
    });  // others do not write over that
    if (!is_input && is_used_file(scenario, /*film=*/"", program)) {
        throw ConfigError(
            fmt::format("the run would overwrite its program '{}'; choose another file to write", program));
    }
}

Scenario scenario_of(pogosim_run_options const& options, bool is_firmware) {
    std::vector<std::string> const settings(options.settings, options.settings + options.setting_count);
    Scenario scenario = load_known_scenario(options.configuration,
                                            {.overrides = settings,
                                             .strict = options.strict != 0,
                                             .firmware = is_firmware ? options.program : "",
                                             .strict_overrides = options.strict_settings != 0},
                                            object_types());
    if (options.seed >= 0) {
        scenario.seed = static_cast<std::uint32_t>(options.seed);
    }
    if (options.program != nullptr) {
        check_program_file(scenario, options.program);
    }
    return scenario;
}

std::atomic<std::uint64_t> runs = 0;

char letter_of(LogLine const& line) {
    constexpr std::string_view letters = "TDIWEC";
    return line.is_of_robot ? 'P' : letters.at(static_cast<std::size_t>(line.level));
}

}  // namespace

pogosim::HostedProgram::HostedProgram(std::filesystem::path const& file) {
    WithoutRobot const no_robot;
    image_ = std::make_unique<ProgramImage const>(load_program(file));
}

pogosim::HostedProgram::~HostedProgram() {
    WithoutRobot const no_robot;
    image_.reset();
}

pogosim_run::pogosim_run(pogosim_run_options const& options) : number(++runs) {
    LogOptions logging;
    logging.on_line = [this](LogLine const& line) { lines_.push_back(line); };
    log_ = std::make_shared<Log>(logging);
    LogScope const scope(log_.get());
    bool const is_firmware = options.program != nullptr && is_firmware_file(options.program);
    if (options.program != nullptr && !is_firmware) {
        program_.emplace(options.program);
    }
    RunOptions run_options;
    run_options.log = log_;
    run_options.conversions = options.strict != 0 ? Conversions::typed : Conversions::lenient;
    simulation_ = std::make_unique<Simulation>(program_ ? program_->image() : ProgramImage{},
                                               scenario_of(options, is_firmware), run_options);
    for (Category const& category : simulation_->world().categories) {
        categories_ += (categories_.empty() ? "" : "\n") + category.name;
    }
    simulation_->keep_columns();
    must_succeed(simulation_->attempt([this] { return simulation_->start(); }));
    for (SavedColumn const& column : simulation_->saved_columns().columns()) {
        columns_ += (columns_.empty() ? "" : "\n") + column.name;
    }
}

pogosim_run::~pogosim_run() {
    try {
        end();
    } catch (std::exception const&) {
        // The outcome is reported by end().
    }
}

void pogosim_run::must_succeed(Outcome const& outcome) {
    if (!outcome.failed()) {
        return;
    }
    std::size_t const before = lines_.size();
    ExitCode const code = conclude(outcome);
    // The log's text becomes the message of the error.
    std::string message = outcome.failure ? outcome.failure->what : *outcome.shortage;
    for (std::size_t i = before; i < lines_.size(); ++i) {
        if (!lines_[i].is_of_robot && lines_[i].level >= spdlog::level::warn) {
            message = lines_[i].text;
            lines_.erase(lines_.begin() + static_cast<std::ptrdiff_t>(i));
            break;
        }
    }
    throw RunFailure(message, code);
}

std::int64_t pogosim_run::step(std::int64_t steps, double budget_s) {
    if (has_failed_) {
        throw ConfigError("the run has failed: reset it");
    }
    if (has_ended_) {
        throw ConfigError("the run has ended: reset it, or make another one");
    }
    try {
        return make_steps(steps, budget_s);
    } catch (...) {
        has_failed_ = true;
        throw;
    }
}

std::int64_t pogosim_run::make_steps(std::int64_t steps, double budget_s) {
    using Clock = std::chrono::steady_clock;
    auto const deadline = Clock::now() + std::chrono::duration<double>(budget_s);
    std::int64_t done = 0;
    Outcome const outcome = simulation_->attempt([&]() -> std::optional<UserFailure> {
        while (done < steps && !is_over() && (done == 0 || Clock::now() < deadline)) {
            if (auto failure = simulation_->step()) {
                return failure;
            }
            ++done;
            in_use.yield();
        }
        return std::nullopt;
    });
    if (outcome.failure && outcome.failure->code == ExitCode::done) {
        conclude(outcome);  // the program has called exit(0)
    } else {
        must_succeed(outcome);
    }
    return done;
}

void pogosim_run::end() {
    if (has_ended_ || !simulation_) {
        return;
    }
    Outcome const outcome = simulation_->attempt([this] { return simulation_->end_programs(); });
    must_succeed(outcome);
    conclude(outcome);
}

ExitCode pogosim_run::conclude(Outcome const& outcome) {
    has_ended_ = true;
    ExitCode const code = simulation_->conclude(outcome);
    simulation_->release_files();
    return code;
}

std::string const& pogosim_run::take_messages() {
    messages_.clear();
    for (LogLine const& line : std::exchange(lines_, {})) {
        messages_ += (messages_.empty() ? "" : "\n") + (letter_of(line) + line.text);
    }
    return messages_;
}
