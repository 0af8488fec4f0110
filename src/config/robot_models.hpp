// Files of `robot_model`: a map of keys that hold for a category where its entry does not have them.
#pragma once

#include <filesystem>
#include <vector>

#include "config/reading.hpp"
#include "config/tree.hpp"

namespace pogosim {

/// Puts the keys of its model into each entry of `objects` that names one, in place of `robot_model`; each key knows
/// the file and line that it came from. Returns the files that were read, each once. A mistake is a problem of the
/// reading, and its entry stays as it is.
std::vector<std::filesystem::path> include_robot_models(Node& root, std::filesystem::path const& configuration,
                                                        Reading& reading);

}  // namespace pogosim
