#include "config/value_or_file.hpp"

#include <filesystem>

#include "config/find_file.hpp"

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

}  // namespace pogosim
