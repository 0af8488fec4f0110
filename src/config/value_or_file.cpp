#include "config/value_or_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "config/find_file.hpp"

namespace pogosim {

WrittenValue value_or_file(Place const& place, FileOfValue const& file, Reading& reading) {
    if (place.node.kind == Node::Kind::sequence || place.node.kind == Node::Kind::map) {
        return {.node = place.node, .path = place.path};
    }
    if (place.node.kind != Node::Kind::scalar || place.node.scalar.empty()) {
        fail_expected(place, file.expected);
    }
    FoundFile const found = search_file(reading.configuration, place.node.scalar);
    if (found.path.empty()) {
        fail_at(place, fmt::format("there is no file '{}'{}", shown(place.node.scalar), found.searched));
    }
    if (std::error_code ignored; std::filesystem::is_directory(found.path, ignored)) {
        fail_at(place, fmt::format("'{}' is a folder; expected a YAML file", shown(place.node.scalar)));
    }
    Node const content = read_yaml_file(found.path.string());
    reading.object_files.push_back({found.path, file.name});
    Node const* const value = content.find(file.key);
    if (value == nullptr || content.entries.size() != 1) {
        fail_at({content, std::string(file.key)}, std::string(file.content));
    }
    return {.node = *value, .path = std::string(file.key)};
}

}  // namespace pogosim
