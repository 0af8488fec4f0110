// Looks for a file that a configuration mentions.
#pragma once

#include <filesystem>
#include <string>

#include "config/places.hpp"
#include "config/scenario.hpp"

namespace pogosim {

/// The file that the configuration sets. A relative name is searched in the working folder, then next to the
/// configuration, then in the folders of files installed or bundled with Pogosim. Throws ConfigError, listing these
/// folders, if there is none. An empty name stays empty.
std::filesystem::path find_file(Scenario const& scenario, Setting setting, std::string const& name);

}  // namespace pogosim
