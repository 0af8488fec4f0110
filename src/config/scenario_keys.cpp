#include "config/scenario_keys.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>
#include <string_view>

#include "config/shape_keys.hpp"

namespace pogosim {

namespace {

std::span<Key<Scenario> const> scenario_keys() {
    using K = Key<Scenario>;
    static std::array const keys{
        // Space.
        K{"arena_file", &Scenario::arena_file, any(), "",
          "Needed. Outline of the arena, CSV; looked for from the working folder, beside the configuration, then in "
          "the folder of Pogosim."},
        K{"arena_surface", NumberOr<Scenario>{&Scenario::arena_surface_mm2, "file"},
          above(0).up_to(kMaxLength * kMaxLength).usually_from(100), "mm2",
          "Area inside the outer wall less the holes; the outline is scaled to it. file: the numbers of the arena file "
          "are millimetres, nothing is scaled."},
        K{"arena_stretch", &Scenario::arena_stretch, any(), "",
          "Stretch the outline so that its bounding box is a square; false: keep its proportions."},
        K{"boundary_condition",
          one_of(&Scenario::boundary, {{"solid", BoundaryCondition::solid}, {"periodic", BoundaryCondition::periodic}}),
          any(), "", "solid: walls. periodic: no walls, what leaves the bounding box comes back on the other side."},
        K{"arena_temperature", &Scenario::arena_temperature_c, between(-273.15, 10000), "C",
          "What the robots' thermometers read."},
        K{"communication_ignore_occlusions", &Scenario::ignore_occlusions, any(), "",
          "Infrared links depend on distance only: no shadows, no facing."},
        K{"light_map_nb_bin_x", &Scenario::light_map_columns, between(1, 10000), "cells", "Columns of the light map."},
        K{"light_map_nb_bin_y", &Scenario::light_map_rows, between(1, 10000), "cells", "Rows of the light map."},
        // Time and chance.
        K{"simulation_time", &Scenario::simulation_time_s, between(0, 1e9), "s", "End of the run."},
        K{"time_step", &Scenario::time_step_s, above(0).up_to(1), "s", "Step of the simulation."},
        K{"seed", &Scenario::seed, any(), "", "Seed of all random numbers; absent: a new one each run."},
        K{"user_code_timeout", &Scenario::user_code_timeout_s, between(0, 1e6), "s",
          "Processor time one call of user code may take, without that of other threads of the program, and wall-clock "
          "time once a signal has asked the run to "
          "end; 0: no limit."},
        // Things.
        K{"objects", Elsewhere{"a map of categories"}, any(), "", "What is in the arena, by category; own tables."},
        K{"parameters", Elsewhere{"a map of keys"}, any(), "", "Values for the global variables of the user program."},
        // For the batch and optimisation tools; the simulator reads past them.
        K{"result_filename_format", Elsewhere{"a text"}, any(), "", "Batch tool: name of each result file."},
        K{"result_new_columns", Elsewhere{"a list of key paths"}, any(), "", "Batch tool: constant columns to add."},
        K{"optimization", Elsewhere{"a map of keys"}, any(), "", "Optimisation tool: its settings."},
        K{"progress_bar", Elsewhere{"true or false"}, any(), "", "Ignored; the command line says it."},
    };
    return keys;
}

std::span<Key<WallSpec> const> wall_keys() {
    using K = Key<WallSpec>;
    static std::array const keys{
        K{"wall_friction", &WallSpec::friction, between(0, 1000), "", "Coulomb friction of the walls."},
        K{"wall_restitution", &WallSpec::restitution, between(0, 1), "", "Bounciness of the walls."},
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
    constexpr auto has_centre = [](FormationSpec const& spec) { return is_one_of(spec, {"disk", "chessboard"}); };
    constexpr auto is_chessboard = [](FormationSpec const& spec) { return is_one_of(spec, {"chessboard"}); };
    constexpr auto is_imported = [](FormationSpec const& spec) { return spec.name == kImportedFormation; };
    NamedValues<std::string> names;
    for (std::string const& name : formation_names()) {
        names.emplace_back(name, name);
    }
    static std::array const keys{
        K{"initial_formation", one_of(&FormationSpec::name, names), any(), "",
          "How objects without x and y are placed."},
        K{"initial_formation_root_object", &FormationSpec::root_object, any(), "",
          "Category whose contour bounds the formation; arena: the walls."},
        K{"initial_formation_center", &FormationSpec::centre_mm, kCoordinate.or_nan(), "mm",
          "Centre of disk formations; .nan: the centroid of the outer wall."}
            .only_if(has_centre),
        K{"formation_min_space_between_neighbors", &FormationSpec::min_space_mm, between(0, kMaxLength), "mm",
          "Lower bound of the radius that each object is given when it is placed."},
        K{"formation_max_space_between_neighbors", &FormationSpec::max_space_mm, kLength.or_infinity(), "mm",
          "random: each object is placed this near another one, centre to centre."}
            .only_if(is_random),
        K{"formation_attempts_per_point", &FormationSpec::attempts_per_point, between(1, 1e9), "",
          "Random places tried for one object before all starts again."}
            .only_if(has_attempts),
        K{"formation_max_restarts", &FormationSpec::max_restarts, between(0, 1e9), "",
          "New starts before the formation is declared impossible."}
            .only_if(has_attempts),
        K{"chessboard_distance_between_neighbors", &FormationSpec::chessboard_pitch_mm, kLength, "mm",
          "chessboard: distance of neighbours on the grid."}
            .only_if(is_chessboard),
        K{"formation_cluster_at_center", &FormationSpec::cluster_at_centre, any(), "",
          "chessboard: around the centre; false: spread over the arena."},
        K{"formation_filename", &FormationSpec::filename, any(), "",
          "imported: CSV or Feather file with the columns x, y and maybe angle; looked for like arena_file."},
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
        K{"data_filename", &OutputConfig::data_filename, any(), "", "The data file, Feather; folders are made."},
        K{"save_data_period", &OutputConfig::save_data_period_s, between(-1e9, 1e9), "s",
          "Time between two sets of rows; 0 or less: only the rows of time 0."}
            .only_if(has_data),
        K{"data_logger_fields", &OutputConfig::fields, any(), "", "Columns to write; absent: all."},
        K{"data_logger_category", &OutputConfig::categories, any(), "",
          "Categories to write; absent: all. At least one must have objects other than lamps."},
        K{"data_logger_flush_row_count", &OutputConfig::flush_row_count, between(1, 1e9), "rows",
          "Rows of one record batch in the file."}
            .only_if(has_data),
        K{"data_logger_led", &OutputConfig::led_column, any(), "", "Add the column led_rgb, the head LED."},
        K{"enable_console_logging", &OutputConfig::enable_console_logging, any(), "", "Write the console file."},
        K{"console_filename", &OutputConfig::console_filename, any(), "", "The console file; folders are made."},
        K{"log_format",
          one_of(&OutputConfig::log_format,
                 {{"default", LogFormat::dated}, {"date", LogFormat::dated}, {"minimal", LogFormat::minimal}}),
          any(), "", "Console lines with date and level, or without."},
    };
    return keys;
}

std::span<Key<ViewConfig> const> view_keys() {
    using K = Key<ViewConfig>;
    static std::array const keys{
        K{"GUI", &ViewConfig::gui, any(), "", "Open the window."},
        K{"GUI_speed_up", &ViewConfig::gui_speed_up, above(0).up_to(1e6), "",
          "Simulated seconds per second in the window."}
            .only_if([](ViewConfig const& view) { return view.gui; }),
        K{"window_width", &ViewConfig::window_width_px, between(1, 16384), "pixels", "Width of window and frames."},
        K{"window_height", &ViewConfig::window_height_px, between(1, 16384), "pixels", "Height of window and frames."},
        K{"mm_to_pixels", &ViewConfig::mm_to_pixels, any(), "pixels per mm",
          "Ignored; the arena is fitted to the window, and the metadata say at which scale."},
        K{"show_time", &ViewConfig::show_time, any(), "", "Write the time."},
        K{"show_scale_bar", &ViewConfig::show_scale_bar, any(), "", "Draw the scale bar."},
        K{"show_communication_channels", &ViewConfig::show_communication_channels, any(), "", "Draw infrared links."},
        K{"show_communication_channels_above_all", &ViewConfig::show_communication_channels_above_all, any(), "",
          "Draw the links above the objects."},
        K{"show_lateral_LEDs", &ViewConfig::show_lateral_leds, any(), "", "Draw LEDs 1 to 4."},
        K{"show_light_levels", &ViewConfig::show_light_levels, any(), "", "Draw the light map."},
        K{"show_trajectory_traces", &ViewConfig::show_trajectory_traces, any(), "", "Draw where robots came from."},
        K{"save_video_period", &ViewConfig::save_video_period_s, between(-1e9, 1e9), "s",
          "Time between two frames; 0 or less: none."},
        K{"frames_name", &ViewConfig::frames_name, any(), "", "Name of a frame; its one {} field is the time in s."},
        K{"delete_old_files", &ViewConfig::delete_old_files, any(), "",
          "Delete *.png in the folder of frames_name first."},
    };
    return keys;
}

}  // namespace

void read_top_level(MapReader& reader, Scenario& scenario) {
    reader.read(scenario_keys(), scenario);
    if (scenario.boundary == BoundaryCondition::solid) {
        reader.read(wall_keys(), scenario.walls);
    } else {
        reader.read_unused(wall_keys(), scenario.walls);
    }
    reader.read(formation_keys(), scenario.formation);
    reader.read(output_keys(), scenario.output);
    reader.read(view_keys(), scenario.view);
}

}  // namespace pogosim
