// Keys of configurations of versions before 0.10, which the simulator no longer reads.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/tree.hpp"

namespace pogosim {

/// "; it is now 'simulation_time'" for the path of an old key; empty for any other.
std::string new_place(std::string_view path);

/// The old keys at the top level.
std::vector<std::string> old_keys(Node const& root);

}  // namespace pogosim
