// Variables that all simulated robots of a program share by mistake, though each real robot has its own.
#pragma once

#include <string>
#include <vector>

#include "debug_info/debug_info.hpp"
#include "debug_info/program_file.hpp"

namespace shared_state {

/// Folders of the system's headers.
std::vector<std::string> system_folders();

/// Variables that the program can modify, in source order, except USERDATA, variables read from the configuration,
/// those marked POGO_SHARED, and those declared in a file of the ignored folders. A variable in a header counts once,
/// however many files include it.
std::vector<Object> shared_variables(DebugInfo const& info, ProgramFile const& program,
                                     std::vector<std::string> const& ignored_folders);

/// Whether a file is in one of these folders, or below.
bool is_in_folders(std::string const& file, std::vector<std::string> const& folders);

/// As compilers print it: relative to the working folder, if inside it.
std::string shown_file(std::string const& file);

/// "'steps' in user_step()"
std::string shown_name(Object const& object);

}  // namespace shared_state
