#include "sim/check_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "base/counted.hpp"
#include "base/input_hash.hpp"
#include "base/locked_file.hpp"
#include "base/log.hpp"
#include "config/find_file.hpp"
#include "process/without_effects.hpp"
#include "render/png_file.hpp"
#include "sim/build_world.hpp"
#include "sim/files_of_run.hpp"
#include "sim/flash_state.hpp"
#include "sim/magnetometers.hpp"
#include "sim/pictures.hpp"

namespace pogosim {

namespace {

void check_picture(Scenario const& scenario, std::string const& film, std::string const& picture, Problems& problems) {
    std::error_code error;
    std::filesystem::path const folder = real_path(picture).parent_path();
    if (!std::filesystem::is_directory(folder, error)) {
        problems.add(
            fmt::format("--picture: '{}' cannot be written: there is no folder '{}'; make it, or choose "
                        "another file",
                        picture, folder.string()));
    }
    if (is_used_file(scenario, film, picture)) {
        problems.add(
            fmt::format("--picture: '{}' is a file that the run reads or writes; choose another file", picture));
    }
    if (std::filesystem::exists(picture, error) && !std::filesystem::is_regular_file(picture, error)) {
        problems.add(fmt::format("--picture: '{}' is there, and not a file; choose another name", picture));
    }
}

void check_files(Scenario const& scenario, CheckOptions const& options, Problems& problems) {
    std::string const& film = options.run.film;
    problems.collect([&] { find_file(scenario, Setting::arena_file, scenario.arena_file); });
    if (scenario.formation.name == kImportedFormation) {
        problems.collect([&] { find_file(scenario, Setting::formation_filename, scenario.formation.filename); });
    }
    problems.collect([&] { check_used_files(scenario, film); });
    check_output_files(scenario, film, problems);
    if (!options.picture.empty()) {
        check_picture(scenario, film, options.picture, problems);
    }
}

/// Whether all keys that determine the world are right. Light, motion and readings of sensors are checked with their
/// defaults where their own keys are wrong.
bool is_world_known(Problems const& problems) {
    constexpr std::array<std::string_view, 4> kKeys{"arena_file", "arena_surface", "arena_stretch",
                                                    "boundary_condition"};
    constexpr std::array<std::string_view, 7> kBeginnings{
        "objects", "initial_formation", "formation_", "chessboard", "imported_formation", "lattice", "links"};
    return std::ranges::none_of(problems.paths(), [&](std::string const& path) {
        return std::ranges::find(kKeys, path) != kKeys.end() ||
               std::ranges::any_of(kBeginnings, [&](std::string_view key) { return path.starts_with(key); });
    });
}

/// Fits their curve to the table now, so that one that determines none hides nothing else: the default model is used
/// then, as it is where keys of the table are wrong. Returns the InputHash of the table.
std::uint64_t check_magnetometers(Scenario& scenario, Problems& problems) {
    auto const is_of_table = [](std::string const& path) { return path.starts_with("magnetometer.csv"); };
    InputHash const read;
    MagnetometerConfig checked;
    checked.seed = scenario.magnetometer.seed;
    if (std::ranges::none_of(problems.paths(), is_of_table)) {
        problems.collect([&] { checked.spec = magnetometers_of(scenario, 0); });
    }
    scenario.magnetometer = checked;
    return read.value();
}

/// The same run, which writes nothing.
Scenario without_outputs(Scenario scenario) {
    scenario.output.enable_data_logging = false;
    scenario.output.message_log.clear();
    scenario.output.enable_console_logging = false;
    scenario.view.save_video_period_s = -1.0;
    scenario.flash_state.output_file.clear();
    if (starts_blank(scenario)) {
        scenario.flash_state.input_file.clear();
    }
    scenario.threads = 1;
    return scenario;
}

/// A world that can always be built: a robot of each category, in a square.
Scenario stand_in(Scenario const& scenario) {
    Scenario other;
    other.file = scenario.file;
    other.source = scenario.source;
    other.robot_memory = scenario.robot_memory;
    other.user_code_timeout_s = scenario.user_code_timeout_s;
    other.arena_file = "arenas/square.csv";
    other.seed = scenario.seed;
    for (ObjectConfig const& object : scenario.objects) {
        bool const is_new =
            std::ranges::find(other.objects, object.category, &ObjectConfig::category) == other.objects.end();
        if (is_new && !object.spec.lamp) {
            ObjectConfig& robot = other.objects.emplace_back();
            robot.category = object.category;
            robot.spec.shape = {.kind = ShapeKind::disk};
            robot.spec.robot.emplace().brain = object.spec.robot ? object.spec.robot->brain : BrainSpec();
            robot.spec.body.emplace();
        }
    }
    return without_outputs(std::move(other));
}

std::unique_ptr<Simulation> built(ProgramImage const& program, Scenario scenario, CheckOptions const& options,
                                  Problems& problems, std::shared_ptr<Log> log = {}) {
    std::unique_ptr<Simulation> simulation;
    RunOptions run;
    run.log = std::move(log);
    run.conversions = options.run.conversions;
    run.save_state_at_s = options.run.save_state_at_s;
    run.save_state_every_s = options.run.save_state_every_s;
    run.inputs = options.run.inputs;
    problems.collect([&] { simulation = std::make_unique<Simulation>(program, std::move(scenario), std::move(run)); });
    return simulation;
}

/// Null if it cannot be built.
std::unique_ptr<Simulation> built_as_written(ProgramImage const& program, Scenario const& scenario,
                                             CheckOptions const& options, Problems& problems) {
    if (is_world_known(problems)) {
        return built(program, without_outputs(scenario), options, problems);
    }
    problems.collect([&] { check_arena(scenario); });
    return nullptr;
}

struct Started {
    bool possible = true;
    Outcome outcome{};
};

/// In a thread of its own, so that the others of this process can still write files.
Started start_without_effects(Simulation& simulation, Problems& problems) {
    Started started;
    std::thread([&] {
        ProcessRun const scope(simulation.crash_handler());
        started.possible = forbid_effects_of_thread();
        if (started.possible) {
            problems.collect([&] { started.outcome = simulation.attempt([&] { return simulation.start(); }); });
        }
    }).join();
    return started;
}

void check_unread_parameters(Simulation const& simulation, bool strict, Problems& problems) {
    UnreadParameters const unread = simulation.parameters().unread();
    if (unread.all.empty()) {
        return;
    }
    constexpr auto what = "parameters that the program does not read before its first step";
    if (strict) {
        problems.add(fmt::format("{}: {} (--strict)", what, unread.all));
    } else {
        log().warn("{}: {}", what, unread.brief);
    }
}

/// Starts the programs, for what they say of their parameters.
void check_programs(Simulation& simulation, bool is_stand_in, bool strict, Problems& problems) {
    simulation.parameters().collect_in(problems);
    auto const [possible, outcome] = start_without_effects(simulation, problems);
    if (!possible) {
        log().warn("the program's parameters are not checked: this system cannot keep programs from writing files");
        return;
    }
    if (simulation.crash_handler().was_interrupted()) {
        log().warn("interrupted: the check is not complete");
        return;
    }
    std::optional<UserFailure> const& failure = outcome.failure;
    bool const is_ours = is_stand_in && !simulation.parameters().has_refused();
    if (failure && failure->refused && !is_ours) {
        problems.add(failure->what);
    } else if (failure || outcome.shortage) {
        if (!is_stand_in) {
            log().warn("the program could not be checked to the end of user_init, without writing files: {}",
                       failure ? failure->what : *outcome.shortage);
        }
    } else {
        check_unread_parameters(simulation, strict, problems);
    }
}

void draw(Scenario const& scenario, Simulation& simulation, std::string const& file) {
    try {
        // A link stays, also one that leads nowhere yet.
        write_png(real_path(file), simulation.picture(picture_size(scenario)));
    } catch (FileError const& error) {
        throw OutputError(
            fmt::format("--picture: '{}' cannot be written: {}; choose another file", file, error.what()));
    }
}

std::string summary_of(World const& world) {
    std::size_t const robots = count_of_robots(world);
    std::size_t const others = world.objects.size() - robots;
    std::string text = counted(robots, "robot");
    if (others > 0) {
        text += ", " + counted(others, "other object");
    }
    if (!world.lamps.empty()) {
        text += ", " + counted(world.lamps.size(), "lamp");
    }
    return text;
}

}  // namespace

CheckResult check_run(ProgramImage const& program, Scenario const& written, CheckOptions options, Problems& problems) {
    CheckResult result;
    bool const is_understood = problems.empty();
    Scenario scenario = written;
    if (problems.has_key("frames_name")) {
        scenario.view.save_video_period_s = -1.0;  // there are no names to look at
    }
    check_files(scenario, options, problems);
    options.run.inputs = check_magnetometers(scenario, problems);
    if (problems.empty() && starts_blank(scenario)) {
        warn_of_blank_start(scenario);
    }
    std::unique_ptr<Simulation> simulation = built_as_written(program, scenario, options, problems);
    bool const is_stand_in = simulation == nullptr;
    if (is_stand_in) {
        problems.collect([&] { check_flash_input(scenario); });
        Problems of_stand_in;  // the substitute world's own mistakes and warnings are dropped
        auto const silent = std::make_shared<Log>(LogOptions{.on_line = [](LogLine const&) {}});
        simulation = built(program, stand_in(scenario), options, of_stand_in, silent);
    } else {
        result.summary = summary_of(simulation->world());
        if (options.run.from_state && is_understood) {  // a mistake in a key would be a difference, too
            problems.collect([&] { simulation->check_state(*options.run.from_state); });
        }
    }
    if (simulation) {
        check_programs(*simulation, is_stand_in, options.run.strict, problems);
        result.user_code_was_aborted = simulation->crash_handler().was_left_by_force();
        result.interrupted = simulation->crash_handler().was_interrupted();
    }
    if (!options.picture.empty() && problems.empty() && !result.interrupted) {
        draw(scenario, *simulation, options.picture);
    }
    if (result.user_code_was_aborted) {
        static_cast<void>(simulation.release());  // its memory may be corrupted
    }
    return result;
}

}  // namespace pogosim
