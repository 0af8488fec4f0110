#include "config/other_level.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "config/object_types.hpp"
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

/// By type.
std::map<std::string, Names, std::less<>> const& names_of_objects() {
    static std::map<std::string, Names, std::less<>> const names = [] {
        std::map<std::string, Names, std::less<>> found;
        for (ObjectType const& type : object_types()) {
            Node const nothing;
            Reading reading;
            MapReader reader(nothing, "objects", reading);
            ObjectConfig object;
            reader.collect([&] { type.read(reader, object); });
            found.emplace(type.name, names_of(reader));
        }
        return found;
    }();
    return names;
}

/// The first category whose type has the key.
std::string category_with(std::string_view key, Node const& root) {
    Node const* const objects = root.find("objects");
    for (auto const& [category, entry] : objects == nullptr ? std::vector<Node::Entry>() : objects->entries) {
        Node const* const type = entry.kind == Node::Kind::map ? entry.find("type") : nullptr;
        auto const names =
            type == nullptr ? names_of_objects().end() : names_of_objects().find(lower_case(type->scalar));
        if (names != names_of_objects().end() && names->second.contains(key)) {
            return category;
        }
    }
    return "<category>";
}

}  // namespace

std::string other_level(std::string_view path, std::string_view key, Node const& map) {
    if (!path.empty()) {
        return names_at_the_top().contains(key) ? "; it belongs at the top level" : "";
    }
    bool const is_of_objects = std::ranges::any_of(
        names_of_objects(), [&](auto const& type_and_names) { return type_and_names.second.contains(key); });
    return is_of_objects
               ? fmt::format("; it belongs in a category, as objects.{}.{}", shown(category_with(key, map)), shown(key))
               : "";
}

}  // namespace pogosim
