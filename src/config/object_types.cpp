#include "config/object_types.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "base/nearest_name.hpp"

namespace pogosim {

namespace {

/// Other names that are understood, too.
struct OtherName {
    std::string_view typed;
    std::string_view meant;
};
constexpr std::array kOtherNames{OtherName{"orbiting_light", "orbiting_static_light"}};

std::vector<std::string> type_names() {
    std::vector<std::string> names;
    std::ranges::transform(object_types(), std::back_inserter(names),
                           [](ObjectType const& type) { return std::string(type.name); });
    return names;
}

ObjectType const& type_at(Place const& place) {
    std::string const typed = lower_case(place.node.scalar);
    auto const other = std::ranges::find(kOtherNames, typed, &OtherName::typed);
    std::string_view const name = other != kOtherNames.end() ? other->meant : typed;
    auto const types = object_types();
    auto const type = std::ranges::find(types, name, &ObjectType::name);
    if (type != types.end()) {
        return *type;
    }
    std::vector<std::string> const names = type_names();
    fail_at(place, fmt::format("expected {}, found {}{}", names_text(names), found_text(place.node),
                               did_you_mean(shown(typed), names)));
}

}  // namespace

std::span<ObjectType const> object_types() {
    static std::vector<ObjectType> const types = [] {
        auto const solid = solid_types();
        auto const lamps = lamp_types();
        std::vector<ObjectType> all(solid.begin(), solid.end());
        all.insert(all.end(), lamps.begin(), lamps.end());
        return all;
    }();
    return types;
}

std::span<Key<ObjectConfig> const> object_keys() {
    static std::string const expected = names_text(type_names());
    static std::array const keys{
        Key<ObjectConfig>{"type", Elsewhere{expected}, any(), "", "Type of the objects; case-insensitive.",
                          /*required=*/true},
        Key<ObjectConfig>{"robot_model", Elsewhere{"the name of a file"}, any(), "",
                          "File of keys that hold for these objects unless they have their own, searched like "
                          "arena_file: models/pogobot_wheels.yaml, ..., or a table of your own robot."},
        Key<ObjectConfig>{"nb", &ObjectConfig::nb, between(0, kMaxObjects), "", "Number of objects."},
    };
    return keys;
}

Node read_object(Place const& place, std::string const& category, Reading& reading, ObjectConfig& object) {
    object.category = category;
    object.line = place.node.where();
    MapReader reader(place.node, place.path, reading);
    reader.read(object_keys(), object);
    Node const* const type_node = reader.find("type");
    if (type_node == nullptr) {
        reader.refuse_missing_keys();
        return {};
    }
    ObjectType const& type = type_at({*type_node, reader.path_of("type")});
    object.type = type.name;
    type.read(reader, object);
    reader.finish();
    reader.set_value("type", plain_node(object.type));
    reader.set_value("nb", value_node(object.nb));
    return reader.values();
}

}  // namespace pogosim
