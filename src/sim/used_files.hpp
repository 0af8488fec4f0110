// The files that a run reads and writes.
#pragma once

#include <string>

#include "config/scenario.hpp"

namespace pogosim {

/// Throws ConfigError, naming both keys, if a file that the run would write is one that it reads or also writes under
/// another key, by whatever name, symbolic or hard link; and if an input file does not exist. Call it before anything
/// is opened for writing. `configuration` is the path of the configuration file.
void check_used_files(Scenario const& scenario, std::string const& configuration);

}  // namespace pogosim
