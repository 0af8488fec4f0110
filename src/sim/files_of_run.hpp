// What can be said of the files that a run will read and write, without touching them.
#pragma once

#include <filesystem>
#include <string>

#include "base/problems.hpp"
#include "config/places.hpp"
#include "config/scenario.hpp"

namespace pogosim {

/// Throws ConfigError, naming both keys, if a file that the run would write is one that it reads or also writes under
/// another key, by whatever name, symbolic or hard link; and if an input file does not exist. Call it before anything
/// is opened for writing. `film`: of --video; empty for none.
void check_used_files(Scenario const& scenario, std::string const& film);

/// True if the run reads this existing file, or writes it; false for one that only becomes a frame.
bool is_used_file(Scenario const& scenario, std::string const& film, std::filesystem::path const& path);

/// Throws ConfigError if the ending of a table's name says no format.
void check_table_format(Scenario const& scenario, Setting setting, std::string const& name);

/// Why no file of this name can be written: "Permission denied"; empty if it can.
std::string why_not_writable(std::string const& name);

/// Adds a mistake for each file of the run that it could not write, and for each name that it would refuse. `film`: of
/// --video; empty for none.
void check_output_files(Scenario const& scenario, std::string const& film, Problems& problems);

}  // namespace pogosim
