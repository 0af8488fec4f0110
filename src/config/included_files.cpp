#include "config/included_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/log.hpp"
#include "config/find_file.hpp"
#include "config/values.hpp"

namespace pogosim {

std::filesystem::path path_of_yaml(Place const& place, std::filesystem::path const& configuration,
                                   std::string_view expected, std::string_view hint) {
    if (place.node.kind != Node::Kind::scalar || place.node.scalar.empty()) {
        fail_expected(place, expected);
    }
    return find_file(place, configuration, "a YAML file", hint);
}

WrittenValue value_or_file(Place const& place, FileOfValue const& file, Reading& reading) {
    if (place.node.kind == Node::Kind::sequence || place.node.kind == Node::Kind::map) {
        return {.node = place.node, .path = place.path};
    }
    std::filesystem::path const path = path_of_yaml(place, reading.configuration, file.expected);
    Node const content = read_yaml_file(path.string(), file.content);
    reading.object_files.push_back({path, file.name});
    Node const* const value = content.find(file.key);
    if (value == nullptr || content.entries.size() != 1) {
        fail_at({content, std::string(file.key)}, std::string(file.content));
    }
    return {.node = *value, .path = std::string(file.key)};
}

namespace {

constexpr std::string_view kKey = "robot_model";

/// Keys that say which objects there are and where, not what they have.
constexpr std::array<std::string_view, 12> kNotOfModels{
    "type", "nb",      "x",         "y", "angle", "poses", "area", "initial_formation", "initial_formation_filename",
    kKey,   "objects", "parameters"};

std::filesystem::path path_of_model(Place const& place, std::filesystem::path const& configuration) {
    return path_of_yaml(place, configuration, "the name of a file, such as models/pogobot_wheels.yaml",
                        ". Bundled models: models/pogobot_wheels.yaml, models/pogobot_brushes.yaml, ...");
}

Node read_model_file(std::string const& path) {
    constexpr std::string_view kContent =
        "a robot model holds keys of a category, such as radius: 26.5, communication_radius: 80, faces or motors";
    Node model = read_yaml_file(path, kContent);
    if (model.entries.empty()) {
        throw ConfigError(fmt::format("{}: the map is empty; {}", model.where(), kContent));
    }
    if (Node const* const other = model.find(kKey)) {
        fail_at({*other, std::string(kKey)},
                "a robot model cannot name another one; copy the keys of that one into this file");
    }
    for (auto const& [key, value] : model.entries) {
        if (std::ranges::find(kNotOfModels, key) != kNotOfModels.end()) {
            fail_at({value, key},
                    "a robot model says what robots have, not which there are or where; move this key into the "
                    "category that names the model");
        }
    }
    return model;
}

/// Says which keys of a model do not count, and warns if none does. `name` is where the entry names it.
void tell_of_unused_keys(Place const& name, Node const& entry, Node const& model) {
    std::vector<std::string_view> keys;
    for (auto const& [key, value] : model.entries) {
        if (entry.find(key) != nullptr) {
            keys.push_back(key);
        }
    }
    std::string const file = shown(name.node.scalar);
    if (keys.size() == model.entries.size()) {
        log().warn(
            "{}: {}: '{}' changes nothing, since the category has {} itself; remove there what the model is to give",
            name.node.where(), name.path, file, fmt::join(keys, ", "));
    } else if (!keys.empty()) {
        log().info("{}: {}: the category has {} itself, so those of '{}' do not count", name.node.where(), name.path,
                   fmt::join(keys, ", "), file);
    }
}

/// The entry with the model's keys first.
Node merged(Node const& entry, Node const& model) {
    Node all = entry;
    all.entries.clear();
    for (auto const& [key, value] : model.entries) {
        if (entry.find(key) == nullptr) {
            all.entries.emplace_back(key, value);
        }
    }
    std::ranges::copy_if(entry.entries, std::back_inserter(all.entries),
                         [](Node::Entry const& own) { return own.key != kKey; });
    return all;
}

}  // namespace

void include_robot_models(Node& root, Reading& reading) {
    std::map<std::filesystem::path, Node> models;
    auto const include = [&](Node& entry, std::string const& path) {
        Node const* const name = entry.find(kKey);
        if (name == nullptr || name->kind == Node::Kind::null) {
            return;
        }
        reading.problems.collect([&] {
            Place const place{*name, fmt::format("{}.{}", path, kKey)};
            std::filesystem::path const file = path_of_model(place, reading.configuration);
            if (!models.contains(file)) {
                models.emplace(file, read_model_file(file.string()));
                reading.object_files.push_back({file, "the robot model"});
            }
            tell_of_unused_keys(place, entry, models.at(file));
            entry = merged(entry, models.at(file));
        });
    };
    Node* const objects = root.find("objects");
    for (std::size_t i = 0; objects != nullptr && i < objects->entries.size(); ++i) {
        auto& [category, entry] = objects->entries[i];
        std::string const path = "objects." + category;
        include(entry, path);
        for (std::size_t k = 0; k < entry.items.size(); ++k) {
            include(entry.items[k], fmt::format("{}.{}", path, k));
        }
    }
}

}  // namespace pogosim
