// Finds the files that a configuration names.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "config/places.hpp"
#include "config/scenario.hpp"
#include "config/values.hpp"

namespace pogosim {

/// Where a file was found that a configuration names, or else which folders were searched for it.
struct FoundFile {
    std::filesystem::path path;  // empty: there is none
    std::string searched;        // "; searched /a, then in /b"; empty for an absolute name
};
/// A relative name is searched in the working folder, then next to the configuration, then in the folders of the
/// environment variable POGOSIM_PATH (separated by ':'), then among the files installed or bundled with Pogosim.
FoundFile search_file(std::filesystem::path const& configuration, std::string const& name);

/// The path of the file that a configuration names at a place, as search_file() finds it. Throws ConfigError at the
/// place if there is none (with the `hint`), or a folder. `expected`: "a YAML file".
std::filesystem::path find_file(Place const& place, std::filesystem::path const& configuration,
                                std::string_view expected, std::string_view hint = {});

/// The same of a setting, whose place is known by its name. An empty name stays empty.
std::filesystem::path find_file(Scenario const& scenario, Setting setting, std::string const& name);

/// Whether an arena file has one of the names by which configurations mean a square without walls: torus.csv and
/// empty.csv. There need be no such file, and it may be empty.
bool is_periodic_square(std::filesystem::path const& name);

/// The outline of that square, which is bundled with Pogosim.
std::filesystem::path bundled_periodic_square();

}  // namespace pogosim
