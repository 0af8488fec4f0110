#include "config/places.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <variant>
#include <vector>

#include "config/source.hpp"
#include "config/values.hpp"

namespace pogosim {

namespace {

/// The key that says how far a shape extends along its longer side, or its shorter one.
std::string size_key(Shape const& shape, bool longer) {
    switch (shape.kind) {
        case ShapeKind::rectangle:
        case ShapeKind::capsule:
            return (shape.width_mm >= shape.height_mm) == longer ? "body_width" : "body_height";
        case ShapeKind::triangle:
            return "side_length";
        case ShapeKind::polygon:
            return "corners";
        case ShapeKind::compound:
            return "parts";
        case ShapeKind::disk:
        case ShapeKind::global:
        case ShapeKind::arena:
            break;
    }
    return "radius";
}

std::string size_key(ObjectSpec const& spec) {
    if (!spec.lamp) {
        return size_key(spec.shape, /*longer=*/true);
    }
    return size_key(spec.lamp->shape(), /*longer=*/false);
}

std::string coordinate_key(Scenario const& scenario, ObjectConfig const& object, std::string const& axis) {
    if (!object.spec.lamp) {
        return object.position_mm ? axis : "poses";
    }
    Node const* const entry = node_of(scenario, object);
    std::string const centre = "center_" + axis;  // of an orbit
    return entry != nullptr && entry->find(centre) != nullptr ? centre : axis;
}

std::string key_of(Scenario const& scenario, ObjectConfig const& object, ObjectSetting setting) {
    switch (setting) {
        case ObjectSetting::angular_speed:
            return "max_angular_speed";
        case ObjectSetting::body_count:
            return "num_dots";
        case ObjectSetting::count:
            return "nb";
        case ObjectSetting::formation:
            return object.own_formation.area_mm ? "area" : "initial_formation";
        case ObjectSetting::linear_speed:
            return "max_linear_speed";
        case ObjectSetting::membrane_thickness:
            return object.spec.membrane->segments && object.spec.membrane->thickness_mm ? "rect_thickness"
                                                                                        : "dot_radius";
        case ObjectSetting::size:
            return size_key(object.spec);
        case ObjectSetting::x:
            return coordinate_key(scenario, object, "x");
        case ObjectSetting::y:
            return coordinate_key(scenario, object, "y");
    }
    return "";
}

std::string line_of_key(Scenario const& scenario, std::string const& key) {
    Node const& tree = source_of(scenario).tree;
    Node const* const value = find_path(tree, key);
    return (value != nullptr ? *value : tree).where();
}

void collect_open_options(Node const& node, std::string const& path, std::vector<std::string>& notes) {
    if (is_open_option(node)) {
        notes.push_back(fmt::format("{} {}", shown(path), node.scalar));
    }
    for (auto const& [key, value] : node.entries) {
        if (!path.empty() || key != "parameters") {
            collect_open_options(value, path.empty() ? key : fmt::format("{}.{}", path, key), notes);
        }
    }
    for (std::size_t i = 0; i < node.items.size(); ++i) {
        collect_open_options(node.items[i], fmt::format("{}.{}", path, i), notes);
    }
}

}  // namespace

std::string note_on_open_options(Scenario const& scenario) {
    std::vector<std::string> notes;
    collect_open_options(source_of(scenario).tree, "", notes);
    return notes.empty() ? "" : fmt::format(" ({})", fmt::join(notes, "; "));
}

std::string key_of(Setting setting) {
    switch (setting) {
        case Setting::arena_file:
            return "arena_file";
        case Setting::arena_surface:
            return "arena_surface";
        case Setting::boundary_condition:
            return "boundary_condition";
        case Setting::color_by:
            return "view.color_by";
        case Setting::follow:
            return "view.follow";
        case Setting::heat_map:
            return "view.heat_map";
        case Setting::console_filename:
            return "console_filename";
        case Setting::data_filename:
            return "data_filename";
        case Setting::delete_old_files:
            return "delete_old_files";
        case Setting::flash_input_file:
            return "flash_state.input_file";
        case Setting::flash_output_file:
            return "flash_state.output_file";
        case Setting::formation_filename:
            return "formation_filename";
        case Setting::formation_root:
            return "initial_formation_root_object";
        case Setting::frames_name:
            return "frames_name";
        case Setting::magnetometer:
            return "magnetometer";
        case Setting::magnetometer_table:
            return "magnetometer.csv.file";
        case Setting::message_log:
            return "message_log";
        case Setting::pause_when:
            return "view.pause_when";
        case Setting::physics_engine:
            return "physics_engine";
        case Setting::save_data_period:
            return "save_data_period";
        case Setting::speed_up:
            return "GUI_speed_up";
        case Setting::threads:
            return "threads";
    }
    return "";
}

std::string line_of(Scenario const& scenario, Setting setting) {
    return line_of_key(scenario, key_of(setting));
}

std::string line_of(Scenario const& scenario, FormationError const& error) {
    return line_of_key(scenario, error.key());
}

std::string place_of(Scenario const& scenario, Setting setting) {
    return fmt::format("{}: {}", line_of(scenario, setting), key_of(setting));
}

std::string place_of(Scenario const& scenario, ObjectConfig const& object, ObjectSetting setting) {
    std::string const key = key_of(scenario, object, setting);
    Node const* const entry = node_of(scenario, object);
    Node const* const value = entry != nullptr ? entry->find(key) : nullptr;
    std::string const line = value != nullptr ? value->where() : object.line;
    return fmt::format("{}{}objects.{}{}.{}", line, line.empty() ? "" : ": ", object.category,
                       object.item ? fmt::format(".{}", *object.item) : "", key);
}

std::string place_of(Scenario const& scenario, LinkConfig const& link, std::string_view key) {
    Node const* const links = source_of(scenario).tree.find("links");
    Node const* const entry = links != nullptr ? links->find(link.name) : nullptr;
    Node const* const value = entry != nullptr ? entry->find(key) : nullptr;
    std::string const line = value != nullptr ? value->where() : link.line;
    return fmt::format("{}{}links.{}.{}", line, line.empty() ? "" : ": ", shown(link.name), key);
}

bool is_written(Scenario const& scenario, Setting setting) {
    return find_path(source_of(scenario).tree, key_of(setting)) != nullptr;
}

}  // namespace pogosim
