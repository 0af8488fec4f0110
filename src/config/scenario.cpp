#include "config/scenario.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/nearest_name.hpp"
#include "config/check_scenario.hpp"
#include "config/included_files.hpp"
#include "config/misplaced_keys.hpp"
#include "config/object_types.hpp"
#include "config/option_keys.hpp"
#include "config/scenario_keys.hpp"
#include "config/source.hpp"

namespace pogosim {

namespace {

/// Slips in words of options leave out a part of a study; what a run would make of the rest says little then.
void check_words(Node const& root, Reading& reading) {
    std::size_t const before = reading.problems.messages().size();
    check_options(root, reading.problems);
    if (!reading.thorough && reading.problems.messages().size() > before) {
        reading.problems.throw_if_any();
    }
    reading.problems.leave_out_known_keys();
}

Node resolved_tree(Node const& written, std::vector<std::string> const& overrides, Reading& reading) {
    Problems& problems = reading.problems;
    // Values of --set replace what the file's options have resolved to, and may be options themselves.
    check_words(written, reading);
    Node root = resolve_options(written, problems);
    for (std::string const& assignment : overrides) {
        problems.collect([&] { apply_override(root, assignment); });
    }
    check_words(root, reading);
    return resolve_options(root, problems);
}

/// These may hold anything, but are maps.
void check_maps_of_tools(Node const& root, Problems& problems) {
    for (std::string_view const key : kMapsOfTools) {
        Node const* const map = root.find(key);
        if (map != nullptr && map->kind != Node::Kind::map && map->kind != Node::Kind::null) {
            problems.collect([&] { fail_expected({*map, std::string(key)}, "a map of keys"); });
        }
    }
}

Node without_maps_of_tools(Node root) {
    std::erase_if(root.entries, [](Node::Entry const& entry) {
        return std::ranges::find(kMapsOfTools, entry.key) != kMapsOfTools.end();
    });
    return root;
}

/// Neither a key of the top level, nor an entry without a type, which a `--set` with a slip in its name makes.
void require_category(Node const& objects, std::string const& category, Node const& node, ObjectTypes const& types) {
    bool const has_no_type = node.kind != Node::Kind::sequence && node.find("type") == nullptr;
    if (std::string const place = has_no_type ? other_level("objects", category, objects, &types) : "";
        !place.empty()) {
        fail_at({node, "objects." + category}, fmt::format("this is no category of objects{}", place));
    }
    bool const is_new = node.source == kSetSource && node.kind == Node::Kind::map && node.find("type") == nullptr;
    if (!is_new) {
        return;
    }
    std::vector<std::string> others;
    for (auto const& [name, other] : objects.entries) {
        if (other.source != kSetSource || other.find("type") != nullptr) {
            others.push_back(name);
        }
    }
    std::string const nearest = did_you_mean(shown(category), others);
    fail_at({node, "objects"},
            fmt::format("unknown category '{}'{}{} To add a category, also set its type", shown(category),
                        others.empty() ? "" : fmt::format(" (known: {})", fmt::join(others, ", ")),
                        nearest.empty() ? "." : nearest));
}

/// Reads all entries. Returns the map `objects` with their values.
Node read_objects(Node const* objects, Reading& reading, std::vector<ObjectConfig>& into) {
    Node values;
    values.kind = Node::Kind::map;
    if (objects == nullptr) {
        return values;
    }
    if (objects->kind != Node::Kind::map) {
        fail_expected({*objects, "objects"}, "a map of categories");
    }
    auto const read = [&](Place const& place, std::string const& category) {
        Node entry;
        reading.problems.collect([&] { entry = read_object(place, category, reading, into.emplace_back()); });
        return entry;
    };
    for (auto const& [category, node] : objects->entries) {
        if (!reading.problems.collect([&, &category = category, &node = node] {
                require_category(*objects, category, node, *reading.types);
            })) {
            continue;
        }
        std::string const path = "objects." + category;
        if (node.kind != Node::Kind::sequence) {
            values.entries.emplace_back(category, read({node, path}, category));
            continue;
        }
        Node list;
        list.kind = Node::Kind::sequence;
        for (std::size_t i = 0; i < node.items.size(); ++i) {
            list.items.push_back(read({node.items[i], fmt::format("{}.{}", path, i)}, category));
            into.back().item = i;
        }
        if (!list.items.empty()) {
            values.entries.emplace_back(category, std::move(list));
        }
    }
    return values;
}

/// For maps of which nothing else is read here.
void require_map(MapReader const& reader, std::string const& key) {
    Node const* const value = reader.find(key);
    if (value != nullptr && value->kind != Node::Kind::map) {
        reader.collect([&] { fail_expected({*value, key}, "a map of keys"); });
    }
}

/// The program reads its parameters later, each when it asks for it.
void refuse_open_parameters(Node const& node, std::string const& path, Problems& problems) {
    if (is_open_option(node)) {
        problems.add(fmt::format("{}: {}: {}", node.where(), shown(path), node.scalar));
    }
    for (auto const& [key, value] : node.entries) {
        refuse_open_parameters(value, path + "." + key, problems);
    }
    for (Node const& item : node.items) {
        refuse_open_parameters(item, path, problems);
    }
}

}  // namespace

std::vector<Placement> given_poses(ObjectConfig const& object) {
    if (object.position_mm) {
        return {static_cast<std::size_t>(object.nb), {*object.position_mm, object.heading_rad}};
    }
    return object.poses;
}

ConfigSource const& source_of(Scenario const& scenario) {
    static ConfigSource const none;
    return scenario.source ? *scenario.source : none;
}

Node const* node_of(Scenario const& scenario, ObjectConfig const& object) {
    Node const* const objects = source_of(scenario).tree.find("objects");
    Node const* const entry = objects != nullptr ? objects->find(object.category) : nullptr;
    return entry != nullptr && object.item ? &entry->items[*object.item] : entry;
}

Scenario read_scenario(std::string const& path, LoadOptions const& options, ObjectTypes const& types,
                       Problems& problems) {
    Scenario scenario;
    scenario.file = path;
    Node const written = read_yaml_file(path);
    Reading reading{
        .strict_keys = options.strict, .strict_values = options.strict_values, .thorough = options.thorough};
    reading.strict_overrides = options.strict_overrides;
    reading.configuration = path;
    reading.firmware = options.firmware;
    reading.types = &types;
    check_maps_of_tools(written, reading.problems);
    ConfigSource source{.tree = resolved_tree(without_maps_of_tools(written), options.overrides, reading),
                        .values = {}};
    if (source.tree.kind != Node::Kind::map) {
        fail_expected({source.tree, "the top level"}, "a map of keys");
    }
    include_robot_models(source.tree, reading);
    MapReader reader(source.tree, "", reading);
    read_top_level(reader, scenario);
    reader.finish(batch_names(written));
    Node objects;
    std::size_t const before = reading.problems.messages().size();
    reader.collect([&] { objects = read_objects(reader.find("objects"), reading, scenario.objects); });
    bool const objects_are_right = reading.problems.messages().size() == before;
    reader.set_value("objects", std::move(objects));
    Node links;
    reader.collect([&] { links = read_links(reader, scenario.links); });
    reader.set_value("links", std::move(links));
    for (ObjectConfig& object : scenario.objects) {
        if (object.spec.robot && !object.spec.robot->flash) {
            object.spec.robot->flash = scenario.flash;
        }
    }
    require_map(reader, "parameters");
    if (Node const* const parameters = reader.find("parameters"); parameters != nullptr && reading.strict_values) {
        refuse_open_parameters(*parameters, "parameters", reading.problems);
    }
    source.values = reader.values();
    scenario.source = std::make_shared<ConfigSource const>(std::move(source));
    scenario.object_files = reading.object_files;
    reading.problems.leave_out_known_keys();
    check_scenario(scenario, objects_are_right, reading);
    problems = std::move(reading.problems);
    return scenario;
}

Scenario load_scenario(std::string const& path, LoadOptions const& options, ObjectTypes const& types) {
    Problems problems;
    Scenario scenario = read_scenario(path, options, types, problems);
    problems.throw_if_any();
    return scenario;
}

}  // namespace pogosim
