#include "app/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "base/escaped.hpp"
#include "base/nearest_name.hpp"
#include "pogosim/host.h"
#include "pogosim/version.h"
#include "process/crash_handler.hpp"

namespace pogosim {

namespace {

/// Whether a text is a decimal number, without a sign, that fits in an unsigned type.
template <class Unsigned>
bool is_decimal(std::string const& text) {
    constexpr std::size_t most_digits = std::numeric_limits<Unsigned>::digits10 + 1;
    bool const digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
    return digits && text.size() <= most_digits && std::stoull(text) <= std::numeric_limits<Unsigned>::max();
}

/// Empty for a decimal number that fits in 32 bits, otherwise an error message.
std::string is_seed(std::string const& text) {
    return is_decimal<std::uint32_t>(text) ? "" : "expected a whole number from 0 to 4294967295, found '" + text + "'";
}

constexpr double kMostSeconds = 1e9;  // of simulated time

/// Empty for a port of gdb, otherwise an error message.
std::string is_port(std::string const& text) {
    return is_decimal<std::uint16_t>(text)
               ? ""
               : "expected a port from 1 to 65535, or 0 for one that is free, found '" + text + "'";
}

std::string is_not_empty(std::string const& text) {
    return text.empty() ? "expected the name of a file, found ''" : "";
}

/// The version, then the lines of pogosim_build_info(), without the end of the last line.
std::string version_text() {
    std::string text = std::string("pogosim " POGOSIM_VERSION_STRING "\n") + pogosim_build_info();
    text.pop_back();
    return text;
}

std::string is_picture(std::string const& text) {
    return text.ends_with(".png") && text.size() > 4 ? ""
                                                     : "expected the name of a picture, .png, found '" + text + "'";
}

/// CLI::Range lets nan pass.
std::string is_not_nan(std::string const& text) {
    return std::isnan(std::strtod(text.c_str(), nullptr)) ? "expected a number of seconds, found '" + text + "'" : "";
}

/// CLI11 parses "-nr" as "-n -r", so it is replaced by the long name.
std::vector<std::string> normalised_arguments(int argc, char const* const* argv) {
    std::vector<std::string> arguments(argv + 1, argv + argc);
    std::replace(arguments.begin(), arguments.end(), std::string("-nr"), std::string("--do-not-show-robot-msg"));
    std::reverse(arguments.begin(), arguments.end());  // CLI11 takes them from the back
    return arguments;
}

void declare_options(CLI::App& app, CommandLine& options) {
    app.add_option("-c,--config", options.config, "configuration file (YAML)")->required()->type_name("FILE");
    app.add_flag("-g,--no-GUI", options.no_gui, "run without a window");
    app.add_flag("--close-at-end", options.close_at_end,
                 "close the window when the simulated time is over, for scripts; else it stays open");
    app.add_flag("-v,--verbose", options.verbose, "show debug messages");
    app.add_flag("-q,--quiet", options.quiet, "show warnings and errors only; takes precedence over -v");
    app.add_flag("--do-not-show-robot-msg", options.hide_robot_lines,
                 "(also -nr) hide robot output on the console; it still goes to the console file");
    app.add_option("-s,--seed", options.seed, "random seed, 0 to 4294967295; overrides the configuration")
        ->type_name("N")
        ->check(is_seed);
    app.add_flag("-P,--progress", options.progress_bar, "show a progress bar");
    app.add_option("--firmware", options.firmware,
                   "run this firmware (ELF file) on the processors of robots, in the place of the program")
        ->type_name("FILE")
        ->check(CLI::ExistingFile);
    CLI::Option* const profile =
        app.add_option("--profile", options.profile,
                       "count where the cycles of the first robot's firmware go, for pogosim profile (.json)")
            ->type_name("FILE")
            ->check(is_not_empty);
    app.add_option("--profile-robots", options.profile_robots, "how many robots are in the profile")
        ->type_name("N")
        ->check(CLI::Range(1U, 100'000U))
        ->needs(profile);
    CLI::Option* const gdb = app.add_option("--gdb", options.gdb_port,
                                            "debug a robot that runs firmware: wait for gdb on this port of this "
                                            "machine; 0: one that is free")
                                 ->type_name("PORT")
                                 ->check(is_port)
                                 ->excludes(profile);
    app.add_option("--gdb-robot", options.gdb_robot, "with --gdb: the id of the robot; else the first with firmware")
        ->type_name("ID")
        ->check(is_seed)
        ->needs(gdb);
    app.add_option("--video", options.video, "make a film of the run (.mp4, .webm or .gif), with ffmpeg")
        ->type_name("FILE")
        ->check(is_not_empty);
    CLI::Option* const save_state =
        app.add_option("--save-state", options.save_state,
                       "save the state of the run in this file at its end, also when it is interrupted")
            ->type_name("FILE")
            ->check(is_not_empty);
    CLI::Option* const save_at =
        app.add_option("--at", options.save_at_s, "with --save-state: save it at this simulated time; the run goes on")
            ->type_name("SECONDS")
            ->check(CLI::Range(0.0, kMostSeconds))
            ->check(is_not_nan)
            ->needs(save_state);
    app.add_option(
           "--save-state-every", options.save_every_s,
           "with --save-state: save it again and again, after this wall-clock time each (0: each step); a run that "
           "cannot be saved goes on without")
        ->type_name("SECONDS")
        ->check(CLI::Range(0.0, kMostSeconds))
        ->check(is_not_nan)
        ->needs(save_state)
        ->excludes(save_at);
    app.add_option("--from-state", options.from_state,
                   "go on from the state in this file: same program and configuration, which may end later")
        ->type_name("FILE")
        ->check(is_not_empty);
    app.add_option("--set", options.overrides,
                   "override a configuration entry, such as objects.robots.nb=50; may be repeated")
        ->type_name("KEY.PATH=VALUE")
        ->allow_extra_args(false);
    app.add_option("--hash", options.hash_period_steps,
                   "print a hash of the run's state after every N steps: equal runs have equal ones")
        ->type_name("N")
        ->check(CLI::Range(std::int64_t{1}, std::numeric_limits<std::int64_t>::max()));
    app.add_flag("--strict", options.strict, "treat unknown configuration keys as errors");
    app.add_flag(
        "--strict-config", options.strict_config,
        "treat values of another type than expected as errors, never as the default; unknown keys are allowed");
    CLI::Option* const check =
        app.add_flag("--check-config", options.check_config,
                     "check the configuration, its arena, formation, files and parameters; run and write nothing");
    app.add_option("--picture", options.picture, "with --check-config: draw the start of the run (.png)")
        ->type_name("FILE")
        ->check(is_picture)
        ->needs(check);
    app.set_version_flag("-V,--version", version_text,
                         "print the version of the library, its commit and what it was built with, and exit");
    app.set_help_flag("-h,--help", "print this help and exit");
}

std::string base_name(std::string const& path) {
    return path.substr(path.find_last_of('/') + 1);
}

int report_usage(CLI::App const& app, std::string const& problem) {
    std::fprintf(stderr, "Error: %s\nUsage: %s -c FILE [options]; -h lists them\n", escaped(problem).c_str(),
                 escaped(app.get_name()).c_str());
    return static_cast<int>(ExitCode::usage);
}

/// "unknown argument '--sead'; did you mean '--seed'?"
std::string unknown_argument(CLI::App const& app) {
    std::vector<std::string> const unknown = app.remaining();
    auto const option = std::find_if(unknown.begin(), unknown.end(), [](auto const& text) { return text[0] == '-'; });
    std::string const& typed = option != unknown.end() ? *option : unknown.back();
    std::vector<std::string> known;
    for (CLI::Option const* known_option : app.get_options()) {
        for (std::string const& name : known_option->get_lnames()) {
            known.push_back("--" + name);
        }
    }
    std::string const nearest = nearest_name(typed, known);
    return "unknown argument '" + typed + "'" + (nearest.empty() ? "" : "; did you mean '" + nearest + "'?");
}

/// CLI11's own messages count required and received arguments.
std::string problem_of(CLI::App const& app, CLI::ParseError const& error) {
    if (dynamic_cast<CLI::ArgumentMismatch const*>(&error) == nullptr) {
        return error.what();
    }
    std::string const what = error.what();
    std::string const name = what.substr(0, what.find(':'));
    bool const is_repeated = std::ranges::any_of(app.get_options(), [&](CLI::Option const* option) {
        return option->get_name() == name && option->count() > 1;
    });
    return name + (is_repeated ? " can be given only once" : " needs a value");
}

}  // namespace

ParsedCommandLine parse_command_line(int argc, char const* const* argv) {
    ParsedCommandLine parsed;
    parsed.options.program_name = argc > 0 ? base_name(argv[0]) : "pogosim";
    CLI::App app{"Simulates a swarm of Pogobots running this program.", parsed.options.program_name};
    app.footer("Exit codes: 0 success, 2 usage, configuration or file error, 3 the program failed, 130 interrupted.");
    declare_options(app, parsed.options);
    try {
        app.parse(normalised_arguments(argc, argv));
    } catch (CLI::CallForVersion const& asked) {
        parsed.exit_code = app.remaining().empty() ? app.exit(asked) : report_usage(app, unknown_argument(app));
    } catch (CLI::Success const& asked) {
        parsed.exit_code = app.exit(asked);
    } catch (CLI::ParseError const& error) {
        // An unknown option is more informative than a missing one.
        parsed.exit_code = report_usage(app, app.remaining().empty() ? problem_of(app, error) : unknown_argument(app));
    }
    return parsed;
}

}  // namespace pogosim
