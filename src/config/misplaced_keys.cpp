#include "config/misplaced_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <vector>

#include "config/object_types.hpp"
#include "config/reference.hpp"
#include "config/scenario_keys.hpp"
#include "config/values.hpp"

namespace pogosim {

namespace {

using Names = std::set<std::string, std::less<>>;

Names names_of(MapReader const& reader) {
    Names names;
    for (KeyDescription const& key : reader.known_keys()) {
        names.insert(key.name);
    }
    return names;
}

Names const& names_at_the_top() {
    static Names const names = [] {
        Node const nothing;
        Reading reading;
        MapReader reader(nothing, "", reading);
        Scenario scenario;
        read_top_level(reader, scenario);
        return names_of(reader);
    }();
    return names;
}

using NamesByType = std::map<std::string, Names, std::less<>>;

NamesByType names_of_objects(ObjectTypes const& types) {
    NamesByType found;
    for (ObjectType const& type : types) {
        Node const nothing;
        Reading reading;
        MapReader reader(nothing, "objects", reading);
        ObjectConfig object;
        reader.collect([&] { type.read(reader, object); });
        found.emplace(type.name, names_of(reader));
    }
    return found;
}

/// The first category whose type has the key.
std::string category_with(std::string_view key, Node const& root, NamesByType const& names_of_types) {
    Node const* const objects = root.find("objects");
    for (auto const& [category, entry] : objects == nullptr ? std::vector<Node::Entry>() : objects->entries) {
        Node const* const type = entry.kind == Node::Kind::map ? entry.find("type") : nullptr;
        auto const names = type == nullptr ? names_of_types.end() : names_of_types.find(lower_case(type->scalar));
        if (names != names_of_types.end() && names->second.contains(key)) {
            return category;
        }
    }
    return "<category>";
}

constexpr std::string_view kOfCategory = "objects.<category>";

/// The category's part of a path in it: "objects.robots". Empty for any other path.
std::string_view category_part(std::string_view path) {
    constexpr std::string_view kObjects = "objects.";
    return path.starts_with(kObjects) ? path.substr(0, path.find('.', kObjects.size())) : "";
}

std::string_view parent_of(std::string_view path) {
    return path.substr(0, path.find('.') == std::string_view::npos ? 0 : path.rfind('.'));
}

bool is_in(std::string_view path, std::string_view map) {
    return path == map || (path.starts_with(map) && path.substr(map.size()).starts_with('.'));
}

}  // namespace

std::string inner_level(std::string_view path, std::string_view key, std::span<std::string const> names) {
    // Groups of types are not looked at here.
    static std::vector<KeyGroup> const groups = configuration_reference(ObjectTypes({}));
    std::string_view const category = category_part(path);
    std::string const map =
        category.empty() ? std::string(path) : fmt::format("{}{}", kOfCategory, path.substr(category.size()));
    std::vector<std::string> places;
    for (KeyGroup const& group : groups) {
        if (group.path.empty() || !group.type.empty()) {
            continue;
        }
        std::string_view const parent = parent_of(group.path);
        std::string_view const name = std::string_view(group.path).substr(parent.empty() ? 0 : parent.size() + 1);
        bool const is_child = parent == map && std::ranges::find(names, name) != names.end();
        for (KeyDescription const& known : group.keys) {
            std::string const place = fmt::format("{}.{}", group.path, known.name);
            bool const is_of_this_map = is_in(map, group.path);
            bool const is_one_further_in = is_child && known.name == key;
            if ((is_of_this_map || is_one_further_in) && place.ends_with(fmt::format(".{}", key))) {
                places.push_back(place.starts_with(kOfCategory)
                                     ? fmt::format("{}{}", category, place.substr(kOfCategory.size()))
                                     : place);
            }
        }
    }
    return places.size() == 1 ? fmt::format("; did you mean '{}'?", shown(places.front())) : "";
}

std::string other_level(std::string_view path, std::string_view key, Node const& map, ObjectTypes const* types) {
    if (!path.empty()) {
        return names_at_the_top().contains(key) ? "; it belongs at the top level" : "";
    }
    NamesByType const names = types == nullptr ? NamesByType() : names_of_objects(*types);
    bool const is_of_objects =
        std::ranges::any_of(names, [&](auto const& type_and_names) { return type_and_names.second.contains(key); });
    return is_of_objects ? fmt::format("; it belongs in a category, as objects.{}.{}",
                                       shown(category_with(key, map, names)), shown(key))
                         : "";
}

namespace {

struct OldName {
    std::string_view old_path;
    std::string_view new_path;
};

constexpr std::array kOldNames{
    OldName{"nBots", "objects.<category>.nb"},
    OldName{"commRadius", "objects.<category>.communication_radius"},
    OldName{"msgSuccessRate", "objects.<category>.msg_success_rate"},
    OldName{"robot_radius", "objects.<category>.radius"},
    OldName{"initial_robot_formation", "initial_formation"},
    OldName{"initial_light_value", "objects.<light>.value"},
    OldName{"showComms", "show_communication_channels"},
    OldName{"simulationTime", "simulation_time"},
    OldName{"timeStep", "time_step"},
    OldName{"photo_start_at", "objects.<light>.photo_start_at"},
    OldName{"photo_start_duration", "objects.<light>.photo_start_duration"},
};

}  // namespace

std::string new_place(std::string_view path) {
    auto const old = std::ranges::find(kOldNames, path, &OldName::old_path);
    return old == kOldNames.end() ? "" : fmt::format("; it is now '{}'", old->new_path);
}

std::vector<std::string> old_keys(Node const& root) {
    std::vector<std::string> found;
    for (Node::Entry const& entry : root.entries) {
        if (std::ranges::find(kOldNames, entry.key, &OldName::old_path) != kOldNames.end()) {
            found.push_back(entry.key);
        }
    }
    return found;
}

}  // namespace pogosim
