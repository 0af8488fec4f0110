// Parts of a configuration that may stand in files of their own: values, as in `script: [...]` or `script: dance.yaml`,
// and robot models.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "config/reading.hpp"
#include "config/tree.hpp"
#include "config/values.hpp"

namespace pogosim {

/// A list or a map, and its key path where it was written.
struct WrittenValue {
    Node node;
    std::string path;
};

struct FileOfValue {
    std::string_view key;       // also in the file, which has no other
    std::string_view expected;  // "the name of a file with a list `script`, or that list"
    std::string_view content;   // what is said of a file with something else, or nothing
    char const* name;           // "the script"
};

/// The path of the YAML file that a configuration names, as search_file() finds it. Throws ConfigError at the place if
/// it is no name (with what was `expected`), or names no file (with the `hint`) or a folder.
std::filesystem::path path_of_yaml(Place const& place, std::filesystem::path const& configuration,
                                   std::string_view expected, std::string_view hint = {});

/// The value under a key, from the file that it names, which is noted in `reading`. Throws ConfigError.
WrittenValue value_or_file(Place const& place, FileOfValue const& file, Reading& reading);

// Files of `robot_model`: a map of keys that hold for a category where its entry does not have them.

/// Puts the keys of its model into each entry of `objects` that names one, in place of `robot_model`; each key knows
/// the file and line that it came from. The files are noted in `reading`. Mistakes are added to
/// `reading.problems`, and their entry stays as it is.
void include_robot_models(Node& root, Reading& reading);

}  // namespace pogosim
