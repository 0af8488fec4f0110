// Telling what a killed run has left behind from the files of users.
#pragma once

#include <filesystem>

namespace pogosim {

/// True for a complete file on its way (complete_file.hpp) whose run was killed: it is empty, or begins as our data
/// files do and has no footer; and no run has it. Its rows are in the unfinished file, so it can go.
bool is_leftover(std::filesystem::path const& path);

}  // namespace pogosim
