// Where values were written, for messages about values that are found later not to work. Outside this room, code names
// values, not keys.
#pragma once

#include <string>
#include <string_view>

#include "config/scenario.hpp"

namespace pogosim {

/// Values at the top level.
enum class Setting {
    arena_file,
    arena_surface,
    boundary_condition,
    color_by,
    console_filename,
    data_filename,
    delete_old_files,
    flash_input_file,
    flash_output_file,
    formation_filename,
    formation_root,
    follow,
    frames_name,
    heat_map,
    magnetometer,
    magnetometer_table,
    message_log,
    pause_when,
    physics_engine,
    save_data_period,
    speed_up,
    threads,
};

/// Values of an entry of `objects`.
enum class ObjectSetting {
    angular_speed,
    body_count,  // of a membrane
    count,
    formation,  // of the entry itself: its area, or its name
    linear_speed,
    membrane_thickness,
    size,  // what makes the shape too large, or a lamp too small
    x,     // or the poses
    y,
};

/// The name of the key: "arena_surface".
std::string key_of(Setting setting);

/// "conf/a.yaml:14"; of a key that is absent the line of the map.
std::string line_of(Scenario const& scenario, Setting setting);

/// "conf/a.yaml:14: arena_surface".
std::string place_of(Scenario const& scenario, Setting setting);

/// "conf/a.yaml:14: objects.robots.radius".
std::string place_of(Scenario const& scenario, ObjectConfig const& object, ObjectSetting setting);

/// "conf/a.yaml:14: links.skeleton.file"; of a key that is absent the line of the entry.
std::string place_of(Scenario const& scenario, LinkConfig const& link, std::string_view key);

/// The line of the key that the error names: "conf/a.yaml:14".
std::string line_of(Scenario const& scenario, FormationError const& error);

/// " (objects.m.radius has batch_options but no default_option; ...)": values of which a single run takes the default
/// because it cannot choose. Empty when there are none.
std::string note_on_open_options(Scenario const& scenario);

/// Whether the file sets this value.
bool is_written(Scenario const& scenario, Setting setting);

}  // namespace pogosim
