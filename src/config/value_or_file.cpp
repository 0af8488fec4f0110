#include "config/value_or_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "config/find_file.hpp"

namespace pogosim {

std::filesystem::path path_of_yaml(Place const& place, std::filesystem::path const& configuration,
                                   std::string_view expected, std::string_view hint) {
    if (place.node.kind != Node::Kind::scalar || place.node.scalar.empty()) {
        fail_expected(place, expected);
    }
    FoundFile const found = search_file(configuration, place.node.scalar);
    if (found.path.empty()) {
        fail_at(place, fmt::format("there is no file '{}'{}{}", shown(place.node.scalar), found.searched, hint));
    }
    if (std::error_code ignored; std::filesystem::is_directory(found.path, ignored)) {
        fail_at(place, fmt::format("'{}' is a folder; expected a YAML file", shown(place.node.scalar)));
    }
    return found.path;
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
