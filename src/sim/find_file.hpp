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

/// Whether an arena file has one of the names by which configurations mean a square without walls: torus.csv and
/// empty.csv. There need be no such file, and it may be empty.
bool is_periodic_square(std::filesystem::path const& name);

/// The outline of that square, which is bundled with Pogosim.
std::filesystem::path bundled_periodic_square();

}  // namespace pogosim
