#include "config/scenario.hpp"

#include "config/check_scenario.hpp"
#include "config/object_types.hpp"
#include "config/scenario_keys.hpp"

namespace pogosim {

namespace {

Node resolved_tree(std::string const& path, std::vector<std::string> const& overrides) {
    // What is set replaces what the file's options have come to, and may offer options itself.
    Node root = resolve_options(read_yaml_file(path));
    for (std::string const& assignment : overrides) {
        apply_override(root, assignment);
    }
    return resolve_options(root);
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
        read.push_back(read_object(category, node, strict));
    }
    return read;
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

std::string where_in_object(Scenario const& scenario, ObjectConfig const& object, std::string const& key) {
    Node const* const objects = scenario.resolved.find("objects");
    Node const* const entry = objects != nullptr ? objects->find(object.category) : nullptr;
    Node const* const value = entry != nullptr ? entry->find(key) : nullptr;
    std::string const where = value != nullptr ? value->where() : object.where;
    return (where.empty() ? "" : where + ": ") + "objects." + object.category + "." + key;
}

Scenario load_scenario(std::string const& path, LoadOptions const& options) {
    Scenario scenario;
    scenario.file = path;
    scenario.resolved = resolved_tree(path, options.overrides);
    if (scenario.resolved.kind != Node::Kind::map) {
        fail_expected({scenario.resolved, "the top level"}, "a map of keys");
    }
    MapReader reader(scenario.resolved, "", options.strict);
    read_top_level(reader, scenario);
    reader.finish();
    scenario.objects = read_objects(reader.find("objects"), options.strict);
    scenario.parameters = read_parameters(reader.find("parameters"));
    check_scenario(scenario);
    return scenario;
}

}  // namespace pogosim
