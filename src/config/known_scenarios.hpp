// Configurations that this process has loaded before, as a host does that makes many runs of one.
#pragma once

#include <string>

#include "config/scenario.hpp"

namespace pogosim {

/// load_scenario(), with the same result, messages and errors. If the process has loaded the same before, and the files
/// say what they said then, they are read, but not interpreted again: that takes as long as building a small world. May
/// be called by several threads; `types` are the same in all calls.
Scenario load_known_scenario(std::string const& path, LoadOptions const& options, ObjectTypes const& types);

}  // namespace pogosim
