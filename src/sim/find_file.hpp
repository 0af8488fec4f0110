// Finds the files that a configuration names.
#pragma once

#include <filesystem>
#include <string>

#include "config/places.hpp"
#include "config/scenario.hpp"

namespace pogosim {

/// Returns the path of a file that the configuration names. A relative name is searched in the working folder, then
/// next to the configuration, then in the folders of files installed or bundled with Pogosim. Throws ConfigError,
/// listing these folders, if there is none. An empty name stays empty.
std::filesystem::path find_file(Scenario const& scenario, Setting setting, std::string const& name);

}  // namespace pogosim
