// The files that a run reads and writes.
#pragma once

#include <string>

#include "config/scenario.hpp"

namespace pogosim {

/// Throws ConfigError, naming both keys, if a file that the run would write is one that it reads, or is to be written
/// under another key, too; by whatever name, symbolic or hard link. Call it before anything is opened for writing.
/// Throws ConfigError, too, when a file to read is not there. `configuration` is the path of the configuration file.
void check_used_files(Scenario const& scenario, std::string const& configuration);

}  // namespace pogosim
