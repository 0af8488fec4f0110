// Files that a configuration names.
#pragma once

#include <filesystem>
#include <string>

#include "config/scenario.hpp"

namespace pogosim {

/// A file that the configuration names under `key`: below the working folder, else below the folders of what comes
/// along. Throws ConfigError when there is none. An empty name stays empty.
std::filesystem::path find_file(Scenario const& scenario, std::string const& key, std::string const& name);

}  // namespace pogosim
