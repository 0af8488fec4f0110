// The files that a run reads and writes.
#pragma once

#include <filesystem>
#include <string>

#include "config/scenario.hpp"

namespace pogosim {

/// Throws ConfigError, naming both keys, if a file that the run would write is one that it reads or also writes under
/// another key, by whatever name, symbolic or hard link; and if an input file does not exist. Call it before anything
/// is opened for writing. `film`: of --video; empty for none.
void check_used_files(Scenario const& scenario, std::string const& film);

/// True if the run reads this existing file, or writes it; false for one that only becomes a frame.
bool is_used_file(Scenario const& scenario, std::string const& film, std::filesystem::path const& path);

}  // namespace pogosim
