// What main() of an executable does: one run of its program, as the command line says.
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iterator>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "app/command_line.hpp"
#include "app/restart.hpp"
#include "app/run_server.hpp"
#include "base/error.hpp"
#include "base/escaped.hpp"
#include "base/floating_point.hpp"
#include "base/log.hpp"
#include "base/memory.hpp"
#include "base/problems.hpp"
#include "config/known_scenarios.hpp"
#include "config/scenario.hpp"
#include "lamps/lamp_types.hpp"
#include "pogosim/program.h"
#include "process/crash_handler.hpp"
#include "process/crash_message.hpp"
#include "process/process.hpp"
#include "process/program_image.hpp"
#include "sim/check_run.hpp"
#include "sim/files_of_run.hpp"
#include "sim/flash_state.hpp"
#include "sim/interrupt.hpp"
#include "sim/kept_files.hpp"
#include "sim/simulation.hpp"
#include "sim/window_module.hpp"

namespace {

using namespace pogosim;

/// A run that has ended, and the one that the user wants instead.
struct Ended {
    ExitCode code = ExitCode::usage;
    std::optional<Restart> restart{};
    bool user_code_was_aborted = false;
    std::string summary{};  // empty: nothing is to be said
};

/// When user code was aborted, memory may be corrupted, or a lock of the heap held for ever by a thread that crashed:
/// destructors could crash, or never return.
struct DestroyIfIntact {
    void operator()(Simulation* simulation) const {
        if (!simulation->crash_handler().was_left_by_force()) {
            std::default_delete<Simulation>()(simulation);
        }
    }
};

/// By which the program was started.
char const* process_name() {
#ifdef __APPLE__
    return getprogname();
#else
    return program_invocation_name;
#endif
}

LoadOptions load_options(CommandLine const& options) {
    return {.overrides = options.overrides,
            .strict = options.strict,
            .strict_values = options.strict_config,
            .thorough = options.check_config || options.strict_config,
            .firmware = options.firmware};
}

Scenario scenario_of(CommandLine const& options) {
    auto const load = is_run_server() ? load_known_scenario : load_scenario;
    return load(options.config, load_options(options), object_types());
}

Conversions conversions(CommandLine const& options) {
    return options.strict_config ? Conversions::exact : options.strict ? Conversions::typed : Conversions::lenient;
}

void tell_of(std::vector<KeptFile> const& files, bool is_watched) {
    for (KeptFile const& file : files) {
        std::error_code error;  // then it is the whole path
        log().info("'{}' of an earlier run is now '{}'{}",
                   escaped(std::filesystem::proximate(file.path, error).string()),
                   escaped(file.kept.filename().string()), is_watched ? " (-g overwrites instead)" : "");
    }
}

/// Whether the program can be started again as it was in `folder`. Once it has left that, the new run will see, and
/// keep all files.
RestartCheck check_restart(CommandLine const& options, std::filesystem::path const& folder) {
    RestartCheck check;
    std::error_code error;
    if (std::filesystem::current_path(error) != folder) {
        return check;
    }
    if (!std::filesystem::is_regular_file(options.config, error)) {
        check.problem =
            fmt::format("the configuration '{}' is not a file that can be read again", escaped(options.config));
        return check;
    }
    try {
        for (KeptFile const& file : earlier_files(scenario_of(options), options.video)) {
            check.overwritten.push_back(fmt::format("{} -> {}", escaped(file.path.filename().string()),
                                                    escaped(file.kept.filename().string())));
        }
    } catch (std::exception const& problem) {
        check.problem = escaped(problem.what());
    }
    return check;
}

LogOptions logging_of(CommandLine const& options) {
    LogOptions logging;
    logging.verbose = options.verbose;
    logging.quiet = options.quiet || (options.check_config && !options.verbose);  // one line is its result
    logging.show_robot_lines = !options.hide_robot_lines && !options.check_config;
    return logging;
}

/// Prints an error. Returns the exit code of a run that would otherwise have ended with `code`.
ExitCode report(char const* error, ExitCode code) {
    flush_logs();
    std::fprintf(stderr, "Error: %s\n", error);
    return code == ExitCode::done ? ExitCode::usage : code;
}

/// The command line has no way to write the arrays: the robots would stand still.
void check_needs_no_host(Scenario const& scenario) {
    for (ObjectConfig const& object : scenario.objects) {
        if (object.spec.robot && object.nb > 0 && std::holds_alternative<HostSpec>(object.spec.robot->brain)) {
            throw ConfigError(
                fmt::format("{}: objects.{}.brain: host: there is no host on the command line; run it from Python with "
                            "pogosim.Simulation, or set brain: program",
                            object.line, object.category));
        }
    }
}

/// A profile must not take the place of another file of the run.
void check_profile_file(Scenario const& scenario, CommandLine const& options) {
    if (!options.profile.empty() && is_used_file(scenario, options.video, options.profile.c_str())) {
        throw ConfigError(
            fmt::format("--profile would overwrite '{}', which the run needs or writes; choose another file",
                        escaped(options.profile)));
    }
}

/// The states of a run must not take the place of another file of it, nor that file theirs.
void check_state_file(Scenario const& scenario, CommandLine const& options) {
    if (!options.save_state.empty() && is_used_file(scenario, options.video, options.save_state)) {
        throw ConfigError(
            fmt::format("--save-state would overwrite '{}', which the run needs or writes; choose another file",
                        escaped(options.save_state)));
    }
    if (!options.from_state.empty() && is_used_file(scenario, options.video, options.from_state)) {
        throw ConfigError(
            fmt::format("--from-state: the run needs '{}' for something else, or would overwrite it; give "
                        "the state another name",
                        escaped(options.from_state)));
    }
}

/// Null without --from-state. The run has the seed of the state.
std::shared_ptr<StateFile const> take_state(Scenario& scenario, CommandLine const& options) {
    if (options.from_state.empty()) {
        return nullptr;
    }
    auto saved = std::make_shared<StateFile>(read_state(options.from_state));
    bool const is_set =
        std::ranges::any_of(options.overrides, [](auto const& own) { return own.starts_with("seed="); });
    std::optional<std::uint32_t> const wanted = options.seed ? options.seed : is_set ? scenario.seed : std::nullopt;
    if (wanted && *wanted != saved->seed) {
        throw ConfigError(fmt::format("--from-state: '{}' is of a run with seed {}, not {}: leave out {}",
                                      options.from_state, saved->seed, *wanted,
                                      options.seed ? "--seed" : "--set seed"));
    }
    scenario.seed = saved->seed;
    return saved;
}

/// A program that has nothing to do was perhaps to do something.
void tell_of_idle_program(Scenario const& scenario) {
    auto const& objects = scenario.objects;
    bool const has_robots =
        std::ranges::any_of(objects, [](ObjectConfig const& object) { return object.spec.robot && object.nb > 0; });
    bool const is_idle = std::ranges::none_of(objects, [](ObjectConfig const& object) {
        return object.spec.robot && object.nb > 0 && needs_program(object.spec.robot->brain);
    });
    if (has_robots && is_idle) {
        bool const has_firmware = std::ranges::any_of(objects, [](ObjectConfig const& object) {
            return object.spec.robot && std::holds_alternative<FirmwareSpec>(object.spec.robot->brain);
        });
        log().info("no category needs the program: {}", has_firmware
                                                            ? "firmware or scripts drive all robots"
                                                            : "all robots follow scripts (brain: {script: ...})");
    }
}

/// --check-config.
Ended check(pogosim_program const& program, CommandLine const& options) {
    start_logging(logging_of(options));
    CheckOptions check_options;
    check_options.run.strict = options.strict;
    check_options.run.conversions = conversions(options);
    check_options.run.film = options.video;
    check_options.run.save_state_at_s = options.save_at_s;
    check_options.run.save_state_every_s = options.save_every_s;
    check_options.picture = options.picture;
    Problems problems;
    Scenario scenario = read_scenario(options.config, load_options(options), object_types(), problems);
    if (options.seed) {
        scenario.seed = options.seed;
    }
    problems.collect([&] { check_needs_no_host(scenario); });
    problems.collect([&] { check_state_file(scenario, options); });
    problems.collect([&] { check_options.run.from_state = take_state(scenario, options); });
    CheckResult const result = check_run(linked_program(program, process_name()), scenario, check_options, problems);
    flush_logs();
    if (result.interrupted) {
        for (std::string const& message : problems.messages()) {
            report(escaped(message).c_str(), ExitCode::interrupted);
        }
        return {.code = ExitCode::interrupted, .user_code_was_aborted = result.user_code_was_aborted};
    }
    problems.throw_if_any();
    std::printf("%s: no mistakes found: %s\n", escaped(options.config).c_str(), result.summary.c_str());
    return {.code = ExitCode::done, .user_code_was_aborted = result.user_code_was_aborted};
}

Ended simulate(pogosim_program const& program, CommandLine const& options, std::filesystem::path const& folder,
               std::optional<Restart> const& restarted) {
    // Until the configuration is read, the console follows the command line.
    LogOptions logging = logging_of(options);
    start_logging(logging);

    Scenario scenario = scenario_of(options);
    if (options.seed) {
        scenario.seed = options.seed;
    }
    if (restarted) {
        scenario.seed = restarted->seed;
    }
    check_needs_no_host(scenario);
    check_used_files(scenario, options.video);
    check_profile_file(scenario, options);
    check_state_file(scenario, options);
    std::shared_ptr<StateFile const> const from_state = take_state(scenario, options);
    logging.minimal = scenario.output.log_format == LogFormat::minimal;
    if (scenario.output.enable_console_logging) {
        logging.file = scenario.output.console_filename;
        logging.appends = from_state != nullptr;
    }
    start_logging(logging);

    if (restarted) {
        log().info("restarted with seed {}", *scenario.seed);
    }
    if (program.main != nullptr) {
        tell_of_idle_program(scenario);
    }
    bool const window = scenario.view.gui && !options.no_gui;
    RunOptions run_options{.progress_bar = options.progress_bar,
                           .measure_stages = false,
                           .strict = options.strict,
                           .conversions = conversions(options),
                           .hash_period_steps = options.hash_period_steps,
                           .film = options.video,
                           .profile = options.profile,
                           .profile_robots = options.profile_robots,
                           .gdb_port = options.gdb_port,
                           .gdb_robot = options.gdb_robot,
                           .window = window,
                           .close_at_end = options.close_at_end,
                           .program_name = options.program_name,
                           .save_state = options.save_state,
                           .save_state_at_s = options.save_at_s,
                           .save_state_every_s = options.save_every_s,
                           .from_state = from_state,
                           .restarted = restarted,
                           .check_restart = [&] { return check_restart(options, folder); }};
    check_flash_output(scenario);
    // A run that is watched, or goes on, replaces nothing that an earlier one has written.
    bool const is_watched = window && has_display() && !(restarted && restarted->overwrite);
    std::vector<KeptFile> const kept = from_state   ? keep_earlier_part(scenario, options.video)
                                       : is_watched ? keep_earlier_files(scenario, options.video)
                                                    : std::vector<KeptFile>();
    std::unique_ptr<Simulation, DestroyIfIntact> simulation;
    try {
        simulation.reset(
            new Simulation(linked_program(program, process_name()), std::move(scenario), std::move(run_options)));
    } catch (...) {
        give_back(kept);
        throw;
    }
    tell_of(kept, is_watched);
    ProcessRun const scope(simulation->crash_handler());
    auto const begin = std::chrono::steady_clock::now();
    ExitCode const code = simulation->run();
    std::chrono::duration<double> const wall = std::chrono::steady_clock::now() - begin;
    Ended ended{code, simulation->restart(), simulation->crash_handler().was_left_by_force(),
                options.quiet ? "" : simulation->summary(wall.count())};
    if (ended.restart && simulation->crash_handler().was_interrupted()) {  // while files were being completed, perhaps
        ended.restart.reset();
        ended.code = code == ExitCode::done ? ExitCode::interrupted : code;
    }
    return ended;
}

/// Destructors of libraries may crash when memory is short.
[[noreturn]] void end_short_of_memory(char const* error) {
    ExitCode const code = report(error, ExitCode::usage);
    std::fflush(nullptr);
    std::_Exit(static_cast<int>(code));
}

/// One run, or what else the command line asks for. Returns the exit code.
int run_as_told(pogosim_program const& program, int argc, char** argv) {
    StandardFloatingPoint const mode;  // a program that was compiled with -Ofast has set another one
    ParsedCommandLine const parsed = parse_command_line(argc, argv);
    if (parsed.exit_code) {
        return *parsed.exit_code;
    }
    std::error_code unknown_folder;
    std::filesystem::path const folder = std::filesystem::current_path(unknown_folder);
    Ended ended;
    ExitCode& code = ended.code;
    try {
        ignore_broken_outputs();
        require_this_interface(program, process_name());
        ended = parsed.options.check_config ? check(program, parsed.options)
                                            : simulate(program, parsed.options, folder, take_restart());
        check_logs();
    } catch (OutOfMemory const& error) {
        end_short_of_memory(error.what());
    } catch (std::bad_alloc const&) {
        end_short_of_memory(kOutOfMemory);
    } catch (std::length_error const&) {  // more than any machine has
        end_short_of_memory(kOutOfMemory);
    } catch (ConfigErrors const& errors) {
        for (std::string const& message : errors.messages()) {
            report(escaped(message).c_str(), code);
        }
        code = ExitCode::usage;
    } catch (std::exception const& error) {
        code = report(escaped(error.what()).c_str(), code);
    }
    flush_logs();
    if (code == ExitCode::done && !ended.summary.empty()) {
        std::fprintf(stderr, "%s\n", ended.summary.c_str());  // with the progress bar, apart from what robots print
    }
    if (ended.restart && (code == ExitCode::done || code == ExitCode::interrupted)) {
        std::fflush(nullptr);
        hold_interrupts();  // until the next run catches them: they would end it without a word
        restart_program(argv, folder, *ended.restart);
        release_interrupts();
        std::fprintf(stderr, "Error: cannot start %s again: %s\n", argv[0], std::strerror(errno));
        return static_cast<int>(ExitCode::usage);
    }
    if (code == ExitCode::user_program || window_was_left_behind() || ended.user_code_was_aborted) {
        // The user's program may have corrupted memory, so skip the destructors.
        std::fflush(nullptr);
        std::_Exit(static_cast<int>(code));
    }
    return static_cast<int>(code);
}

}  // namespace

void pogosim_guard_process() {
    take_process();
    catch_interrupts();
    if (is_restarted()) {
        release_interrupts();  // held since the end of the run before
    }
    expect_run_server();
}

int pogosim_run_program(pogosim_program const* program, int argc, char** argv) {
    if (is_forked_child()) {
        end_forked_child(0);  // forked by a constructor; the run belongs to the parent
    }
    enter_stage(RunStage::preparing);
    if (is_run_server() && has_this_interface(*program)) {
        return serve_runs(linked_program(*program, process_name()), [&](std::vector<std::string> arguments) {
            std::vector<char*> words{argv[0]};
            std::ranges::transform(arguments, std::back_inserter(words), [](auto& word) { return word.data(); });
            words.push_back(nullptr);
            return run_as_told(*program, static_cast<int>(words.size()) - 1, words.data());
        });
    }
    return run_as_told(*program, argc, argv);
}
