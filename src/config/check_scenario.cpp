#include "config/check_scenario.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <regex>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/log.hpp"
#include "base/nearest_name.hpp"
#include "config/misplaced_keys.hpp"
#include "config/source.hpp"
#include "config/values.hpp"

namespace pogosim {

namespace {

// Indices have 32 bits, some of them with a sign.
constexpr std::int64_t kMaxBodies = std::numeric_limits<std::int32_t>::max();

/// The node of a top-level key, or the whole tree when the file leaves the key out.
Place place_of(Scenario const& scenario, std::string const& key) {
    Node const* node = source_of(scenario).tree.find(key);
    return {node == nullptr ? source_of(scenario).tree : *node, key};
}

void check_counts(Scenario const& scenario) {
    constexpr double kMaxCount = 9007199254740992.0;  // 2^53: beyond it a double skips integers
    struct Period {
        char const* key;
        double period_s;
    };
    std::array const periods{
        Period{"time_step", scenario.time_step_s},
        Period{"save_data_period", scenario.output.enable_data_logging ? scenario.output.save_data_period_s : 0.0},
        Period{"save_video_period", scenario.view.save_video_period_s},
    };
    for (auto const& [key, period_s] : periods) {
        if (period_s > 0.0 && scenario.simulation_time_s / period_s > kMaxCount) {
            fail_at(place_of(scenario, key), fmt::format("{} s is too short for a run of {} s; use at least {} s",
                                                         number_text(period_s), number_text(scenario.simulation_time_s),
                                                         number_text(scenario.simulation_time_s / kMaxCount)));
        }
    }
}

/// Throws for a configuration that was written for a version that made robots of `nBots` and others.
void refuse_old_keys(Scenario const& scenario) {
    Node const& root = source_of(scenario).tree;
    std::vector<std::string> const keys = old_keys(root);
    if (keys.empty()) {
        return;
    }
    Node const* const count = root.find("nBots");
    fail_at(
        place_of(scenario, keys.front()),
        fmt::format("no robot would be created: the keys of versions before 0.10 ({}) have no effect. Describe the "
                    "robots under 'objects', as in objects: {{robots: {{type: pogobot, nb: {}, geometry: disk, "
                    "radius: 26.5}}}}, or begin with a new project: pogosim new NAME",
                    fmt::join(keys, ", "), count != nullptr && number_of(*count) ? count->scalar : std::string("20")));
}

void check_object_count(Scenario const& scenario) {
    std::int64_t robots = 0;
    std::int64_t all = 0;
    std::int64_t bodies = 0;
    for (ObjectConfig const& object : scenario.objects) {
        robots += object.spec.robot ? object.nb : 0;
        all += object.spec.robot || object.spec.body ? object.nb : 0;
        bodies += std::int64_t{object.nb} * (object.spec.membrane ? object.spec.membrane->body_count : 1);
    }
    if (all > kMaxObjects) {
        fail_at(place_of(scenario, "objects"),
                fmt::format("expected at most {} objects in all categories, found {}", kMaxObjects, all));
    }
    if (bodies > kMaxBodies) {
        fail_at(place_of(scenario, "objects"),
                fmt::format("expected at most {} dots of membranes and other objects, found {}", kMaxBodies, bodies));
    }
    if (robots == 0) {
        refuse_old_keys(scenario);
    }
    if (robots == 0 && scenario.links.empty()) {
        log().warn("{}: objects: there are no robots in this configuration; nothing will move",
                   place_of(scenario, "objects").node.where());
    }
}

/// Throws when the file that key `needed_by` asks for has no name.
void require_name(Scenario const& scenario, char const* key, std::string const& name, char const* needed_by) {
    Node const* node = source_of(scenario).tree.find(key);
    if (name.empty() || (node != nullptr && node->kind == Node::Kind::null)) {
        Node const& cause = node == nullptr ? place_of(scenario, needed_by).node : *node;
        if (node != nullptr && is_open_option(*node)) {
            fail_at({cause, key}, node->scalar);
        }
        fail_at({cause, key}, fmt::format("expected a file name, found nothing; '{}' needs it", needed_by));
    }
}

void check_file_names(Scenario const& scenario) {
    if (source_of(scenario).tree.find("arena_file") != nullptr) {
        require_name(scenario, "arena_file", scenario.arena_file, "arena_surface");
    }
    if (scenario.output.enable_data_logging) {
        require_name(scenario, "data_filename", scenario.output.data_filename, "enable_data_logging");
    }
    if (scenario.output.enable_console_logging) {
        require_name(scenario, "console_filename", scenario.output.console_filename, "enable_console_logging");
    }
}

/// Categories whose objects have rows in the data file, each once.
std::vector<std::string> categories_with_rows(Scenario const& scenario) {
    std::vector<std::string> names;
    for (ObjectConfig const& object : scenario.objects) {
        bool const has_rows = object.spec.robot || object.spec.body;
        if (has_rows && std::ranges::find(names, object.category) == names.end()) {
            names.push_back(object.category);
        }
    }
    return names;
}

/// The allow-list of categories has to leave at least one; unknown names in it are typing mistakes.
void check_recorded_categories(Scenario const& scenario) {
    std::vector<std::string> const known = categories_with_rows(scenario);
    auto const is_known = [&known](std::string const& name) { return std::ranges::find(known, name) != known.end(); };
    auto const& wanted = scenario.output.categories;
    if (!scenario.output.enable_data_logging || !wanted || known.empty()) {
        return;
    }
    Place const place = place_of(scenario, "data_logger_category");
    std::string const choice = fmt::format("{}", fmt::join(known, ", "));
    if (std::ranges::none_of(*wanted, is_known)) {
        std::string const found = wanted->empty() ? "" : shown(wanted->front());
        fail_at(place, fmt::format("expected at least one of the categories with rows in the data file, {}; found {}{} "
                                   "(without this key, all are recorded)",
                                   choice, wanted->empty() ? "none" : "'" + found + "'", did_you_mean(found, known)));
    }
    for (std::string const& name : *wanted) {
        if (!is_known(name)) {
            log().warn("{}: {}: '{}' is ignored; the categories with rows in the data file are {}{}",
                       place.node.where(), place.path, shown(name), choice, did_you_mean(shown(name), known));
        }
    }
}

/// The text between the only two braces of a name, or nothing when it has other braces or none.
std::optional<std::string> only_field(std::string const& name) {
    std::size_t const open = name.find_first_of("{}");
    std::size_t const close = open == std::string::npos ? open : name.find_first_of("{}", open + 1);
    bool const is_one = close != std::string::npos && name[open] == '{' && name[close] == '}' &&
                        name.find_first_of("{}", close + 1) == std::string::npos;
    return is_one ? std::optional(name.substr(open + 1, close - open - 1)) : std::nullopt;
}

/// A format of one floating-point number, with no width that would fill the memory.
bool is_number_format(std::string const& field) {
    static std::regex const pattern("(:[-+ <>^]{0,2}0?[0-9]{0,3}([.][0-9]{1,3})?[eEfFgG]?)?");
    constexpr std::size_t kLongest = 20;
    return field.size() <= kLongest && std::regex_match(field, pattern);
}

void check_frames_name(Scenario const& scenario) {
    if (scenario.view.save_video_period_s <= 0.0) {
        return;
    }
    std::optional<std::string> const field = only_field(scenario.view.frames_name);
    if (!field || !is_number_format(*field)) {
        fail_at(place_of(scenario, "frames_name"),
                fmt::format("expected a name with one field for the time, like 'frames/f{{:010.4f}}.png', found '{}'",
                            shown(scenario.view.frames_name)));
    }
}

void check_arena(Scenario const& scenario) {
    if (scenario.arena_stretch && !scenario.arena_surface_mm2) {
        fail_at(place_of(scenario, "arena_stretch"),
                "expected false, because 'arena_surface: file' keeps the size of the file; specify an area in mm2 "
                "to stretch it");
    }
}

void check_walls(Scenario const& scenario) {
    if (scenario.boundary == BoundaryCondition::solid && scenario.walls.restitution > 1.0F) {
        Place const place = place_of(scenario, "wall_restitution");
        log().warn(
            "{}: wall_restitution: at {}, above 1, walls add energy: what has no motors leaves a wall faster than it "
            "came, up to {} mm/s; real walls have less than 1 (default: {})",
            place.node.where(), scenario.walls.restitution, kMostBounceMmS, WallSpec().restitution);
    }
}

/// Levels of lamps have 15 bits, however many those of the sensors' converter are.
void check_light_levels(Scenario const& scenario) {
    constexpr int kMuchFewerBits = kLightBits - 3;
    ObjectConfig const* brightest = nullptr;
    int level = 0;
    for (ObjectConfig const& object : scenario.objects) {
        if (object.spec.lamp && object.nb > 0 && (brightest == nullptr || object.spec.lamp->brightest() > level)) {
            brightest = &object;
            level = object.spec.lamp->brightest();
        }
    }
    for (ObjectConfig const& object : scenario.objects) {
        int const bits = object.spec.robot && object.nb > 0 ? object.spec.robot->sensors.photosensor_bits : kLightBits;
        if (brightest != nullptr && level > 0 && bits <= kMuchFewerBits && level < 1 << bits) {
            log().warn(
                "{}: objects.{}: no lamp is brighter than {}, which light sensors of {} bits, such as those of "
                "'{}', read as {}: the levels of lamps go up to {} with any photosensors_bits; perhaps they "
                "should be {} times higher",
                brightest->line, shown(brightest->category), level, bits, shown(object.category),
                level >> (kLightBits - bits), (1 << kLightBits) - 1, 1 << (kLightBits - bits));
            return;
        }
    }
}

/// Warns of code that is to take time, and takes none, because nothing says how much.
void check_cpu_time(Scenario const& scenario) {
    for (ObjectConfig const& object : scenario.objects) {
        if (!object.spec.robot || object.nb == 0) {
            continue;
        }
        RobotSpec const& robot = *object.spec.robot;
        bool const is_counted = robot.cpu_time == CpuTime::counted;
        bool const is_program = needs_program(robot.brain);
        std::string const place = shown(object.category);
        if (is_counted && is_program && robot.function_costs.empty()) {
            log().warn(
                "{}: objects.{}.cpu_time: counted has an effect on firmware (brain: FILE.elf, or --firmware FILE), and "
                "on programs in C with function_costs; the code of these robots takes no time",
                object.line, place);
        } else if (is_counted && !is_program && !std::holds_alternative<FirmwareSpec>(robot.brain)) {
            log().warn("{}: objects.{}.cpu_time: counted has no effect on robots that no code drives", object.line,
                       place);
        } else if (!robot.function_costs.empty() && !(is_counted && is_program)) {
            log().warn("{}: objects.{}.function_costs have an effect on programs in C alone, with cpu_time: counted",
                       object.line, place);
        }
    }
}

/// Warns of robots that would never do anything.
void check_scripts(Scenario const& scenario) {
    constexpr double kFarBeyond = 100.0;  // nearer ones may be those of a longer run
    for (ObjectConfig const& object : scenario.objects) {
        auto const* const script = object.spec.robot ? std::get_if<ScriptSpec>(&object.spec.robot->brain) : nullptr;
        Node const* const node = node_of(scenario, object);
        bool const is_written = node != nullptr && node->find("brain") != nullptr;
        if (script == nullptr || object.nb == 0 || !is_written) {
            continue;  // walls have one that does nothing where a firmware is in the place of the program
        }
        if (script->entries.empty()) {
            log().warn("{}: objects.{}.brain: the script is empty, so these robots do nothing", object.line,
                       shown(object.category));
        } else if (script->entries.front().time_s >= scenario.simulation_time_s) {
            log().warn(
                "{}: objects.{}.brain: the script begins at {} s, but the run ends at {} s (simulation_time), so these "
                "robots do nothing",
                object.line, shown(object.category), number_text(script->entries.front().time_s),
                number_text(scenario.simulation_time_s));
        } else if (double const last_s = script->entries.back().time_s;
                   last_s >= kFarBeyond * scenario.simulation_time_s) {
            log().warn(
                "{}: objects.{}.brain: the script goes on until {} s, far beyond the end of the run (simulation_time: "
                "{}); times are in s, not in ms",
                object.line, shown(object.category), number_text(last_s), number_text(scenario.simulation_time_s));
        }
    }
}

void check_formation(Scenario const& scenario) {
    constexpr std::array<std::string_view, 3> kArena{"arena", "null", ""};
    std::string const& root = scenario.formation.root_object;
    bool const is_arena = std::ranges::find(kArena, root) != kArena.end();
    if (!is_arena && std::ranges::find(scenario.objects, root, &ObjectConfig::category) == scenario.objects.end()) {
        fail_at(place_of(scenario, "initial_formation_root_object"),
                fmt::format("expected 'arena' or a category of 'objects', found '{}'", shown(root)));
    }
    if (scenario.formation.name == kImportedFormation) {
        require_name(scenario, "formation_filename", scenario.formation.filename, "initial_formation");
    }
}

/// `thorough`: also where the formation looks at neither of them.
void check_spaces(Scenario const& scenario, bool thorough) {
    FormationSpec const& formation = scenario.formation;
    bool const is_used = formation.name == "random" || formation.name == "aligned_random";
    if ((is_used || thorough) && formation.max_space_mm < formation.min_space_mm) {
        fail_at(place_of(scenario, "formation_max_space_between_neighbors"),
                fmt::format("expected at least formation_min_space_between_neighbors, {} mm, found {}",
                            number_text(formation.min_space_mm), number_text(formation.max_space_mm)));
    }
}

}  // namespace

void check_scenario(Scenario const& scenario, bool objects_are_right, Reading& reading) {
    auto const collect = [&reading](auto const& check) { reading.problems.collect(check); };
    collect([&] { check_counts(scenario); });
    if (objects_are_right) {
        collect([&] { check_object_count(scenario); });
        collect([&] { check_recorded_categories(scenario); });
        collect([&] { check_light_levels(scenario); });
        collect([&] { check_cpu_time(scenario); });
        collect([&] { check_scripts(scenario); });
        for (LinkConfig const& link : scenario.links) {
            collect([&] { check_link(scenario, link); });
        }
    }
    collect([&] { check_file_names(scenario); });
    collect([&] { check_frames_name(scenario); });
    collect([&] { check_arena(scenario); });
    collect([&] { check_walls(scenario); });
    collect([&] { check_formation(scenario); });
    collect([&] { check_spaces(scenario, reading.thorough); });
}

}  // namespace pogosim
