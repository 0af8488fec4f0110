// Starting a run again, from its window: the program replaces itself, so that all variables of the user's program are
// as new.
#pragma once

#include <filesystem>
#include <optional>

#include "view/messages.hpp"

namespace pogosim {

/// Whether a run before has left something for this one.
bool is_restarted();

/// What the run before has left for this one, if there was one. The next call finds nothing, and neither do programs
/// that this one starts.
std::optional<Restart> take_restart();

/// Starts the program again with the same arguments in the folder in which it was started. Returns only if that fails,
/// with errno set.
void restart_program(char** argv, std::filesystem::path const& folder, Restart const& restart);

}  // namespace pogosim
