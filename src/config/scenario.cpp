#include "config/scenario.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/nearest_name.hpp"
#include "config/batch_names.hpp"
#include "config/check_options.hpp"
#include "config/check_scenario.hpp"
#include "config/object_types.hpp"
#include "config/scenario_keys.hpp"
#include "config/source.hpp"

namespace pogosim {

namespace {

Node resolved_tree(Node const& written, std::vector<std::string> const& overrides) {
    // Values of --set replace what the file's options have resolved to, and may be options themselves.
    check_options(written);
    Node root = resolve_options(written);
    for (std::string const& assignment : overrides) {
        apply_override(root, assignment);
    }
    check_options(root);
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

/// Reads all entries. Returns the map `objects` with their values.
Node read_objects(Node const* objects, bool strict, std::vector<ObjectConfig>& into) {
    Node values;
    values.kind = Node::Kind::map;
    if (objects == nullptr) {
        return values;
    }
    if (objects->kind != Node::Kind::map) {
        fail_expected({*objects, "objects"}, "a map of categories");
    }
    for (auto const& [category, node] : objects->entries) {
        require_category(*objects, category, node);
        std::string const path = "objects." + category;
        if (node.kind != Node::Kind::sequence) {
            values.entries.emplace_back(category, read_object({node, path}, category, strict, into.emplace_back()));
            continue;
        }
        Node list;
        list.kind = Node::Kind::sequence;
        for (std::size_t i = 0; i < node.items.size(); ++i) {
            Place const place{node.items[i], fmt::format("{}.{}", path, i)};
            list.items.push_back(read_object(place, category, strict, into.emplace_back()));
            into.back().item = i;
        }
        if (!list.items.empty()) {
            values.entries.emplace_back(category, std::move(list));
        }
    }
    return values;
}

void require_map(Node const* parameters) {
    if (parameters != nullptr && parameters->kind != Node::Kind::map) {
        fail_expected({*parameters, "parameters"}, "a map of keys");
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

Scenario load_scenario(std::string const& path, LoadOptions const& options) {
    Scenario scenario;
    scenario.file = path;
    Node const written = read_yaml_file(path);
    ConfigSource source{.tree = resolved_tree(written, options.overrides), .values = {}};
    if (source.tree.kind != Node::Kind::map) {
        fail_expected({source.tree, "the top level"}, "a map of keys");
    }
    MapReader reader(source.tree, "", options.strict);
    read_top_level(reader, scenario);
    reader.finish(batch_names(written));
    reader.set_value("objects", read_objects(reader.find("objects"), options.strict, scenario.objects));
    for (ObjectConfig& object : scenario.objects) {
        if (object.spec.robot && !object.spec.robot->flash) {
            object.spec.robot->flash = scenario.flash;
        }
    }
    require_map(reader.find("parameters"));
    source.values = reader.values();
    scenario.source = std::make_shared<ConfigSource const>(std::move(source));
    check_scenario(scenario);
    return scenario;
}

}  // namespace pogosim
