#include "config/scenario_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "base/log.hpp"
#include "config/shape_keys.hpp"
#include "physics/physics_engine.hpp"

namespace pogosim {

namespace {

constexpr int kLeastStackKib = 64;

std::span<Key<Scenario> const> scenario_keys() {
    using K = Key<Scenario>;
    NamedValues<std::string> engines;
    for (std::string const& name : physics_engine_names()) {
        engines.emplace_back(name, name);
    }
    static std::array const keys{
        // Space.
        K{"arena_file", &Scenario::arena_file, any(), "",
          "Required. Outline of the arena (CSV); searched in the working folder, next to the configuration file, then "
          "in Pogosim's own folder."}
            .needing_a_name(),
        K{"arena_surface", NumberOr<Scenario>{&Scenario::arena_surface_mm2, "file"},
          above(0).up_to(kMaxLength * kMaxLength).usually_from(100), "mm2",
          "Area inside the outer wall minus the holes; the outline is scaled to match it. file: the arena file is in "
          "millimetres and is not scaled."},
        K{"arena_stretch", &Scenario::arena_stretch, any(), "",
          "Stretch the outline so that its bounding box becomes a square; false: keep the proportions."},
        K{"boundary_condition",
          one_of(&Scenario::boundary, {{"solid", BoundaryCondition::solid}, {"periodic", BoundaryCondition::periodic}}),
          any(), "",
          "solid: walls. periodic: no walls; whatever leaves the bounding box re-enters on the opposite side."},
        K{"arena_temperature", &Scenario::arena_temperature_c, between(-273.15, 10000), "C",
          "Temperature that the robots' thermometers read."},
        K{"communication_ignore_occlusions", &Scenario::ignore_occlusions, any(), "",
          "Infrared links depend on distance only, ignoring occlusion and the direction of emitters and receivers."},
        K{"wall_message_copies",
          one_of(&Scenario::wall_copies,
                 {{"one_per_face", WallCopies::one_per_face}, {"original", WallCopies::original}}),
          any(), "",
          "Copies that a robot gets of a message from a wall or a membrane. one_per_face: one at each face that hears "
          "it. original: as many as in the original simulator, where sending in four directions or one by one reaches "
          "a robot with k such faces k x k times."},
        K{"light_map_nb_bin_x", &Scenario::light_map_columns, between(1, 10000), "cells", "Columns of the light map."},
        K{"light_map_nb_bin_y", &Scenario::light_map_rows, between(1, 10000), "cells", "Rows of the light map."},
        K{"magnetometer", Elsewhere{kMagnetometerMap}, any(), "",
          "What the magnetometers of robots measure; see its own table. Default: an ellipse with typical numbers."},
        // Time and chance.
        K{"simulation_time", &Scenario::simulation_time_s, between(0, 1e9), "s", "Simulated duration of the run."},
        K{"time_step", &Scenario::time_step_s, above(0).up_to(1), "s", "Simulation step."},
        K{"physics_engine", one_of(&Scenario::physics_engine, engines), any(), "",
          "What moves the objects. auto: disk. "
          "disk: the simulator's own engine, several times faster. box2d: Box2D 2.4."},
        K{"threads", NumberOr<Scenario, int>{&Scenario::threads, "auto"}, between(1, kMostThreads), "",
          "Threads that share the work of a run; results are the same with any number. auto: one for every 2000 "
          "objects, up to the number of processors. Many runs at a time are faster with one thread each."},
        K{"seed", &Scenario::seed, any(), "", "Random seed; if omitted, each run draws a new one."},
        K{"user_code_timeout", &Scenario::user_code_timeout_s, between(0, 1e6), "s",
          "Limit on the processor time of one call to user code, or between two of its waits (excluding other threads "
          "of the program), and on its wall-clock time once a signal has requested a stop; 0: no limit."},
        K{"robot_memory",
          one_of(&Scenario::robot_memory, {{"auto", RobotMemoryKind::automatic},
                                           {"shared", RobotMemoryKind::shared},
                                           {"own", RobotMemoryKind::own}}),
          any(), "",
          "Variables of the user program outside USERDATA. shared: one for all robots. own: each robot has its own, as "
          "on real robots, except those marked POGO_SHARED; the robots then take their steps on one thread. auto: own "
          "for programs written for the robots' SDK (pogobot.h), else shared."},
        K{"robot_stack_size", &Scenario::robot_stack_kib, between(kLeastStackKib, 1 << 20).whole(), "KiB",
          "Stack on which the program of a robot runs. Only what is used of it takes memory."},
        K{"coroutine_stack_size", &Scenario::coroutine_stack_bytes, between(1, 1 << 30), "bytes",
          "The same in bytes, rounded up to at least 64 KiB, as the original simulator has it."}
            .other_name_of("robot_stack_size"),
        K{"flash", one_of(&Scenario::flash, flash_writes()), any(), "",
          "How robots of all categories write flash memory, see `flash` of objects; default: overwrite."}
            .only_if([](Scenario const& scenario) { return scenario.flash.has_value(); }),
        K{"flash_state", Elsewhere{kFlashStateMap}, any(), "",
          "Files that keep the flash memory of robots from one run to the next; see its own table."},
        K{"view", Elsewhere{kViewMap}, any(), "",
          "What the window, frames and films show, beside the arena and its objects; see its own table. These keys "
          "replace show_time and the like, and prevail over them."}
            .may_be_empty(),
        // Things.
        K{"objects", Elsewhere{"a map of categories"}, any(), "",
          "Everything in the arena, by category; see the tables below."}
            .may_be_empty(),
        K{"links", Elsewhere{kLinksMap}, any(), "",
          "Springs, rods and hinges between objects, by names of your own; see their own table."}
            .may_be_empty(),
        K{"parameters", Elsewhere{"a map of keys"}, any(), "", "Values for the global variables of the user program."}
            .may_be_empty(),
        // For the batch and optimisation tools; the simulator reads past them.
        K{"pogobatch", Elsewhere{"a map of keys"}, any(), "", "For batch tools: their settings."}.may_be_empty(),
        K{"_rundr", Elsewhere{"a map of keys"}, any(), "", "For batch tools: settings of the scheduler Rundra."}
            .may_be_empty(),
        K{"result_filename_format", Elsewhere{"a string"}, any(), "", "For batch tools: name of each result file."}
            .may_be_empty(),
        K{"result_new_columns", Elsewhere{"a list of key paths"}, any(), "",
          "For batch tools: constant columns to add."}
            .may_be_empty(),
        K{"optimization", Elsewhere{"a map of keys"}, any(), "", "For optimisation tools: their settings."}
            .may_be_empty(),
        K{"progress_bar", Elsewhere{"true or false"}, any(), "", "Ignored; use the command-line option -P."}
            .may_be_empty(),
    };
    return keys;
}

constexpr double kMostRestitution = 10.0;

std::span<Key<WallSpec> const> wall_keys() {
    using K = Key<WallSpec>;
    static std::array const keys{
        K{"wall_friction", &WallSpec::friction, between(0, 1000), "", "Coulomb friction coefficient of the walls."},
        K{"wall_restitution", &WallSpec::restitution, between(0, kMostRestitution), "",
          "Coefficient of restitution of the walls; above 1, they add energy."},
        K{"walls_block_infrared", &WallSpec::block_infrared, any(), "",
          "No message passes the walls: the outline of the arena and its holes."}
            .left_out_at_default<&WallSpec::block_infrared, false>(),
        K{"walls_block_light", &WallSpec::block_light, any(), "",
          "The walls throw shadows in the light of lamps with `casts_shadows`."}
            .left_out_at_default<&WallSpec::block_light, true>(),
    };
    return keys;
}

/// True when the formation is of these, aligned or not.
bool is_one_of(FormationSpec const& formation, std::initializer_list<std::string_view> names) {
    std::string_view name = formation.name;
    if (constexpr std::string_view kAligned = "aligned_"; name.starts_with(kAligned)) {
        name.remove_prefix(kAligned.size());
    }
    return std::ranges::find(names, name) != names.end();
}

std::span<Key<FormationSpec> const> formation_keys() {
    using K = Key<FormationSpec>;
    constexpr auto is_random = [](FormationSpec const& spec) { return is_one_of(spec, {"random"}); };
    constexpr auto has_attempts = [](FormationSpec const& spec) {
        return is_one_of(spec, {"random", "random_near_walls"});
    };
    constexpr auto has_centre = [](FormationSpec const& spec) {
        return is_one_of(spec, {"disk", "chessboard", "lattice"});
    };
    constexpr auto is_a_lattice = [](FormationSpec const& spec) { return is_lattice(spec.name); };
    constexpr auto is_chessboard = [](FormationSpec const& spec) { return is_one_of(spec, {"chessboard"}); };
    constexpr auto is_imported = [](FormationSpec const& spec) { return spec.name == kImportedFormation; };
    NamedValues<std::string> names;
    for (std::string const& name : formation_names()) {
        names.emplace_back(name, name);
    }
    static std::array const keys{
        K{"initial_formation", one_of(&FormationSpec::name, names), any(), "",
          "How to place objects without x and y, poses, or their own initial_formation."},
        K{"initial_formation_root_object", &FormationSpec::root_object, any(), "",
          "Category whose outline bounds the formation; arena: the walls."},
        K{"initial_formation_center", &FormationSpec::centre_mm, kCoordinate.or_nan(), "mm",
          "Centre of disk, chessboard and lattice formations; .nan: the centroid of the outer wall."}
            .only_if(has_centre),
        K{"formation_min_space_between_neighbors", &FormationSpec::min_space_mm, between(0, kMaxLength), "mm",
          "Smallest radius assumed for an object during placement."},
        K{"formation_max_space_between_neighbors", &FormationSpec::max_space_mm, kLength.or_infinity(), "mm",
          "random: maximum centre-to-centre distance from each object to its nearest neighbour."}
            .only_if(is_random),
        K{"formation_attempts_per_point", &FormationSpec::attempts_per_point, between(1, 1e9), "",
          "Random positions tried for one object before placement restarts."}
            .only_if(has_attempts),
        K{"formation_max_restarts", &FormationSpec::max_restarts, between(0, 1e9), "",
          "Restarts before placement fails."}
            .only_if(has_attempts),
        K{"chessboard_distance_between_neighbors", &FormationSpec::chessboard_pitch_mm, kLength, "mm",
          "chessboard: distance between neighbours on the grid."}
            .only_if(is_chessboard),
        K{"formation_cluster_at_center", &FormationSpec::cluster_at_centre, any(), "",
          "chessboard: place objects around the centre; false: spread them over the arena."},
        K{"lattice_kind",
          one_of(&FormationSpec::lattice_kind,
                 {{"triangular", LatticeKind::triangular}, {"square", LatticeKind::square}}),
          any(), "",
          "lattice: triangular (six neighbours each, a patch with the outline of a hexagon) or square (four "
          "neighbours, a patch with the outline of a square)."}
            .only_if(is_a_lattice),
        K{"lattice_distance_between_neighbors", &FormationSpec::lattice_spacing_mm, kLength, "mm",
          "lattice: distance between the centres of neighbours; default: 2.021 times the radius of the largest object, "
          "or as many times formation_min_space_between_neighbors if that is larger."}
            .only_if(is_a_lattice),
        K{"formation_filename", &FormationSpec::filename, any(), "",
          "imported: CSV or Feather file with columns x, y and optionally angle; searched like arena_file."}
            .needing_a_name(),
        K{"formation_time", NumberOr<FormationSpec>{&FormationSpec::time_s, "last"}, between(0, 1e9), "s",
          "imported: time of the rows in the file, the last one at or before this; 0: the first of the file; last: its "
          "last."}
            .only_if(is_imported),
        K{"imported_formation_min_coords", &FormationSpec::imported_min, any().or_nan(), "unit of the file",
          "imported: corner of the file's box that is mapped onto the arena's bounding box; .nan: no mapping."}
            .only_if(is_imported),
        K{"imported_formation_max_coords", &FormationSpec::imported_max, any().or_nan(), "unit of the file",
          "imported: the opposite corner."}
            .only_if(is_imported),
    };
    return keys;
}

std::span<Key<OutputConfig> const> output_keys() {
    using K = Key<OutputConfig>;
    constexpr auto has_data = [](OutputConfig const& output) { return output.enable_data_logging; };
    static std::array const keys{
        K{"enable_data_logging", &OutputConfig::enable_data_logging, any(), "", "Write the data file."},
        K{"data_filename", &OutputConfig::data_filename, any(), "",
          "Data file; the ending says the format: .feather, .parquet or .csv. Missing folders are created."}
            .needing_a_name(),
        K{"save_data_period", &OutputConfig::save_data_period_s, between(-1e9, 1e9), "s",
          "Time between records; shorter than time_step: a record at every step; 0 or less: only record time 0."}
            .only_if(has_data),
        K{"save_data_times",
          one_of(&OutputConfig::row_timing, {{"multiples", RowTiming::multiples}, {"original", RowTiming::original}}),
          any(), "",
          "multiples: records at the first step at or after each multiple of the period. original: as in the original "
          "simulator, whose period begins anew at each record and whose sum of time steps is rounded: 0, 1.01, 2.02, "
          "..."}
            .only_if(has_data),
        K{"data_logger_fields", &OutputConfig::fields, any(), "", "Columns to record; default: all."},
        K{"data_logger_category", &OutputConfig::categories, any(), "",
          "Categories to record; default: all. At least one must have objects other than lamps."},
        K{"data_logger_flush_row_count", &OutputConfig::flush_row_count, between(1, 1e9), "rows",
          "Rows per record batch of the file."}
            .only_if(has_data),
        K{"data_logger_led", &OutputConfig::led_column, any(), "",
          "Add the column led_rgb, the colour of the head LED."},
        K{"message_log", &OutputConfig::message_log, any(), "",
          "Message log, a row for each message and robot in reach; format as that of the data file. Empty: none."}
            .only_if([](OutputConfig const& output) { return !output.message_log.empty(); }),
        K{"enable_console_logging", &OutputConfig::enable_console_logging, any(), "", "Write the console file."},
        K{"console_filename", &OutputConfig::console_filename, any(), "", "Console file; missing folders are created."}
            .needing_a_name(),
        K{"log_format",
          one_of(&OutputConfig::log_format,
                 {{"default", LogFormat::dated}, {"date", LogFormat::dated}, {"minimal", LogFormat::minimal}}),
          any(), "", "default, date: console lines with date and level; minimal: without."},
    };
    return keys;
}

std::span<Key<ViewConfig> const> view_keys() {
    using K = Key<ViewConfig>;
    static std::array const keys{
        K{"GUI", &ViewConfig::gui, any(), "", "Open the window."},
        K{"GUI_speed_up", &ViewConfig::gui_speed_up, between(0, 1e6), "",
          "Simulated seconds per second in the window; 0: as fast as possible."}
            .only_if([](ViewConfig const& view) { return view.gui; }),
        K{"window_width", &ViewConfig::window_width_px, between(1, kMostPixels), "pixels",
          "Width of the window and of frames."},
        K{"window_height", &ViewConfig::window_height_px, between(1, kMostPixels), "pixels",
          "Height of the window and of frames."},
        K{"mm_to_pixels", &ViewConfig::mm_to_pixels, any(), "pixels per mm",
          "Ignored; the arena is fitted to the window. The metadata contain the scale."},
        K{"show_time", &ViewConfig::time, any(), "", "Display the time."},
        K{"show_scale_bar", &ViewConfig::scale_bar, any(), "", "Draw the scale bar."},
        K{"show_communication_channels", &ViewConfig::show_communication_channels, any(), "", "Draw infrared links."},
        K{"show_communication_channels_above_all", &ViewConfig::show_communication_channels_above_all, any(), "",
          "Draw the links above the objects."},
        K{"show_lateral_LEDs", &ViewConfig::lateral_leds, any(), "", "Draw LEDs 1 to 4."},
        K{"show_light_levels", &ViewConfig::light_levels, any(), "", "Draw the light map."},
        K{"show_trajectory_traces", &ViewConfig::trails, any(), "", "Draw the trajectories of robots."},
        K{"save_video_period", &ViewConfig::save_video_period_s, between(-1e9, 1e9), "s",
          "Simulated time between frames; 0 or less: no frames."},
        K{"frames_name", &ViewConfig::frames_name, any(), "",
          "File name of a frame (PNG); its only {} field is the time in s. Missing folders are created."},
        K{"delete_old_files", &ViewConfig::delete_old_files, any(), "",
          "Delete all files *.png in the folder of frames_name at the start of a run that draws frames, except those "
          "that the run itself reads or writes; not in its subfolders."},
    };
    return keys;
}

/// True if a category has a formation of its own, which reads the keys of formations, too.
bool has_own_formation(MapReader const& reader) {
    Node const* const objects = reader.find("objects");
    return objects != nullptr && std::ranges::any_of(objects->entries, [](Node::Entry const& entry) {
               return entry.value.find("initial_formation") != nullptr;
           });
}

/// Warns of keys of one formation if initial_formation does not ask for any.
void warn_without_formation(MapReader const& reader, FormationSpec const& formation) {
    struct Group {
        std::string_view formation;
        std::initializer_list<std::string_view> keys;
    };
    static std::array<Group, 4> const groups{{
        {kImportedFormation,
         {"formation_filename", "formation_time", "imported_formation_min_coords", "imported_formation_max_coords"}},
        {"chessboard", {"chessboard_distance_between_neighbors", "formation_cluster_at_center"}},
        {"lattice", {"lattice_kind", "lattice_distance_between_neighbors"}},
        {"random", {"formation_max_space_between_neighbors"}},
    }};
    if (reader.find("initial_formation") != nullptr) {
        return;
    }
    for (Group const& group : groups) {
        std::vector<std::string_view> given;
        std::ranges::copy_if(group.keys, std::back_inserter(given),
                             [&](std::string_view key) { return reader.find(key) != nullptr; });
        // No category can be imported on its own.
        if (!given.empty() && (group.formation == kImportedFormation || !has_own_formation(reader))) {
            log().warn("{}: {} no effect with initial_formation {}, the default; set initial_formation to {}",
                       reader.find(given.front())->where(),
                       fmt::format("{} {}", fmt::join(given, ", "), given.size() == 1 ? "has" : "have"), formation.name,
                       group.formation);
        }
    }
}

/// The stack of so many bytes, or the least that every machine can give.
int stack_kib(std::int64_t bytes) {
    return static_cast<int>(std::max<std::int64_t>((bytes + 1023) / 1024, kLeastStackKib));
}

}  // namespace

void read_top_level(MapReader& reader, Scenario& scenario) {
    reader.read(scenario_keys(), scenario);
    if (reader.find("coroutine_stack_size") != nullptr) {
        scenario.robot_stack_kib = stack_kib(scenario.coroutine_stack_bytes);
        reader.note_values(scenario_keys(), scenario);
    }
    reader.collect([&] { scenario.flash_state = read_flash_state(reader); });
    if (scenario.boundary == BoundaryCondition::solid) {
        reader.read(wall_keys(), scenario.walls);
    } else {
        reader.read_unused(wall_keys(), scenario.walls);
    }
    reader.read(formation_keys(), scenario.formation);
    warn_without_formation(reader, scenario.formation);
    reader.collect([&] { scenario.magnetometer = read_magnetometer(reader); });
    reader.read(output_keys(), scenario.output);
    read_view(reader, scenario.view);
}

void read_view(MapReader& reader, ViewConfig& view) {
    reader.read(view_keys(), view);
    if (view.show_communication_channels) {
        view.links = view.show_communication_channels_above_all ? LinkLayer::above : LinkLayer::below;
    }
    reader.collect([&] { reader.read_map("view", kViewMap, [&](MapReader& map) { read_view_map(map, view); }); });
}

}  // namespace pogosim
