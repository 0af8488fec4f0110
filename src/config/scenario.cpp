#include "config/scenario.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/nearest_name.hpp"
#include "config/batch_names.hpp"
#include "config/check_scenario.hpp"
#include "config/object_types.hpp"
#include "config/scenario_keys.hpp"

namespace pogosim {

namespace {

Node resolved_tree(Node const& written, std::vector<std::string> const& overrides) {
    // What is set replaces what the file's options have come to, and may offer options itself.
    Node root = resolve_options(written);
    for (std::string const& assignment : overrides) {
        apply_override(root, assignment);
    }
    return resolve_options(root);
}

/// A `--set` with a slip in the category's name makes an entry that has no type.
void require_category(Node const& objects, std::string const& category, Node const& node) {
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

std::vector<ObjectConfig> read_objects(Node const* objects, bool strict) {
    std::vector<ObjectConfig> read;
    if (objects == nullptr) {
        return read;
    }
    if (objects->kind != Node::Kind::map) {
        fail_expected({*objects, "objects"}, "a map of categories");
    }
    for (auto const& [category, node] : objects->entries) {
        require_category(*objects, category, node);
        if (node.kind != Node::Kind::sequence) {
            read.push_back(read_object({node, "objects." + category}, category, strict));
            continue;
        }
        for (std::size_t i = 0; i < node.items.size(); ++i) {
            Place const place{node.items[i], fmt::format("objects.{}.{}", category, i)};
            read.push_back(read_object(place, category, strict));
            read.back().item = i;
        }
    }
    return read;
}

/// The map `objects` with the values of all entries.
Node values_of(std::vector<ObjectConfig> const& objects) {
    Node map;
    map.kind = Node::Kind::map;
    for (ObjectConfig const& object : objects) {
        Node* category = map.find(object.category);
        if (category == nullptr) {
            category = &map.entries.emplace_back(object.category, Node{}).value;
        }
        if (!object.item) {
            *category = object.values;
        } else {
            category->kind = Node::Kind::sequence;
            category->items.push_back(object.values);
        }
    }
    return map;
}

Node read_parameters(Node const* parameters) {
    if (parameters == nullptr) {
        return {};
    }
    if (parameters->kind != Node::Kind::map) {
        fail_expected({*parameters, "parameters"}, "a map of keys");
    }
    return *parameters;
}

}  // namespace

std::vector<Placement> given_poses(ObjectConfig const& object) {
    if (object.position_mm) {
        return {static_cast<std::size_t>(object.nb), {*object.position_mm, object.heading_rad}};
    }
    return object.poses;
}

std::string where_at_top(Scenario const& scenario, std::string const& key) {
    Node const* const value = scenario.resolved.find(key);
    return (value != nullptr ? *value : scenario.resolved).where();
}

Node const* node_of(Scenario const& scenario, ObjectConfig const& object) {
    Node const* const objects = scenario.resolved.find("objects");
    Node const* const entry = objects != nullptr ? objects->find(object.category) : nullptr;
    return entry != nullptr && object.item ? &entry->items[*object.item] : entry;
}

std::string where_in_object(Scenario const& scenario, ObjectConfig const& object, std::string const& key) {
    Node const* const entry = node_of(scenario, object);
    Node const* const value = entry != nullptr ? entry->find(key) : nullptr;
    std::string const where = value != nullptr ? value->where() : object.where;
    return fmt::format("{}{}objects.{}{}.{}", where, where.empty() ? "" : ": ", object.category,
                       object.item ? fmt::format(".{}", *object.item) : "", key);
}

Scenario load_scenario(std::string const& path, LoadOptions const& options) {
    Scenario scenario;
    scenario.file = path;
    Node const written = read_yaml_file(path);
    scenario.resolved = resolved_tree(written, options.overrides);
    if (scenario.resolved.kind != Node::Kind::map) {
        fail_expected({scenario.resolved, "the top level"}, "a map of keys");
    }
    MapReader reader(scenario.resolved, "", options.strict);
    read_top_level(reader, scenario);
    reader.finish(batch_names(written));
    scenario.objects = read_objects(reader.find("objects"), options.strict);
    scenario.parameters = read_parameters(reader.find("parameters"));
    reader.set_value("objects", values_of(scenario.objects));
    scenario.values = reader.values();
    check_scenario(scenario);
    return scenario;
}

}  // namespace pogosim
