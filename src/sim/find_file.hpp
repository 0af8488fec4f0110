// Looks for a file that a configuration mentions.
#pragma once

#include <filesystem>
#include <string>

#include "config/scenario.hpp"

namespace pogosim {

/// A file that the configuration names under `key`. A relative name is looked for in the working folder, then beside
/// the configuration, then in the folders of what is installed or bundled with Pogosim. Throws ConfigError, naming
/// them, when there is none. An empty name stays empty.
std::filesystem::path find_file(Scenario const& scenario, std::string const& key, std::string const& name);

}  // namespace pogosim
