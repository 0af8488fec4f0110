// What can be said of the files that a run will write, without touching them.
#pragma once

#include <string>

#include "base/problems.hpp"
#include "config/places.hpp"
#include "config/scenario.hpp"

namespace pogosim {

/// Throws ConfigError if the ending of a table's name says no format.
void check_table_format(Scenario const& scenario, Setting setting, std::string const& name);

/// Why no file of this name can be written: "Permission denied"; empty if it can.
std::string why_not_writable(std::string const& name);

/// Adds a mistake for each file of the run that it could not write, and for each name that it would refuse. `film`: of
/// --video; empty for none.
void check_output_files(Scenario const& scenario, std::string const& film, Problems& problems);

}  // namespace pogosim
