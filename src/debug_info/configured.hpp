// Finds the variables that a program reads from the configuration.
#pragma once

#include <cstdint>
#include <set>

#include "debug_info/debug_info.hpp"

namespace shared_state {

/// Addresses of the objects that the notes mean, by the rules of C for names: first the function, then the file, then
/// other files. What is behind a pointer is not looked for.
std::set<uint64_t> configured_objects(DebugInfo const& info);

}  // namespace shared_state
