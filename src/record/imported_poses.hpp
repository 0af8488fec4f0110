// Poses from the data file of an earlier run, for the formation `imported`.
#pragma once

#include <filesystem>

#include "geometry/formation.hpp"

namespace pogosim {

/// All rows of a Feather V2 file with columns x and y, optionally angle (rad) and time (s); theta is the angle in files
/// of other programs. Throws ConfigError when the file cannot be read or a column is missing or not numeric.
ImportedPoses read_imported_feather(std::filesystem::path const& path);

}  // namespace pogosim
