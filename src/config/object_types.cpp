#include "config/object_types.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "base/nearest_name.hpp"

namespace pogosim {

namespace {

/// Other names that are understood, too.
struct OtherName {
    std::string_view typed;
    std::string_view meant;
};
constexpr std::array kOtherNames{OtherName{"orbiting_light", "orbiting_static_light"}};

}  // namespace

ObjectTypes::ObjectTypes(std::span<ObjectType const> lamps) {
    auto const solid = solid_types();
    types_.assign(solid.begin(), solid.end());
    types_.insert(types_.end(), lamps.begin(), lamps.end());
    std::ranges::transform(types_, std::back_inserter(names_),
                           [](ObjectType const& type) { return std::string(type.name); });
    names_text_ = names_text(names_);
    common_keys_ = {
        Key<ObjectConfig>{"type", Elsewhere{names_text_}, any(), "", "Type of the objects; case-insensitive.",
                          /*required=*/true},
        Key<ObjectConfig>{"robot_model", Elsewhere{"the name of a file"}, any(), "",
                          "File of keys that hold for these objects unless they have their own, searched like "
                          "arena_file: models/pogobot_wheels.yaml, ..., or a table of your own robot."},
        Key<ObjectConfig>{"nb", &ObjectConfig::nb, between(0, kMaxObjects), "", "Number of objects."},
    };
}

ObjectType const& ObjectTypes::at(Place const& place) const {
    std::string const typed = lower_case(place.node.scalar);
    auto const other = std::ranges::find(kOtherNames, typed, &OtherName::typed);
    std::string_view const name = other != kOtherNames.end() ? other->meant : typed;
    auto const type = std::ranges::find(types_, name, &ObjectType::name);
    if (type != types_.end()) {
        return *type;
    }
    fail_at(place, fmt::format("expected {}, found {}{}", names_text_, found_text(place.node),
                               did_you_mean(shown(typed), names_)));
}

Node read_object(Place const& place, std::string const& category, Reading& reading, ObjectConfig& object) {
    object.category = category;
    object.line = place.node.where();
    MapReader reader(place.node, place.path, reading);
    reader.read(reading.types->common_keys(), object);
    Node const* const type_node = reader.find("type");
    if (type_node == nullptr) {
        reader.refuse_missing_keys();
        return {};
    }
    ObjectType const& type = reading.types->at({*type_node, reader.path_of("type")});
    object.type = type.name;
    object.drawn_as = type.drawn_as;
    type.read(reader, object);
    reader.finish();
    reader.set_value("type", plain_node(object.type));
    reader.set_value("nb", value_node(object.nb));
    return reader.values();
}

}  // namespace pogosim
