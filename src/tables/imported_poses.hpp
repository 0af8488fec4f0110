#pragma once

#include <filesystem>

#include "geometry/formation.hpp"

namespace pogosim {

/// What read_imported_feather() (record/imported_poses.hpp) returns and throws.
ImportedPoses read_poses(std::filesystem::path const& path);

}  // namespace pogosim
