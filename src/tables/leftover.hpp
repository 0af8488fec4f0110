// Tells the remains of a killed run from the files of users.
#pragma once

#include <filesystem>

namespace pogosim {

/// True for a complete file in progress (complete_file.hpp) whose run was killed: it is empty, or begins as our data
/// files do and has no footer; and no run holds its lock. Its rows are in the unfinished file, so it can be removed.
bool is_leftover(std::filesystem::path const& path);

}  // namespace pogosim
