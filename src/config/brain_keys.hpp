// The key `brain` of a category: what drives its robots, see docs/brains.md.
#pragma once

#include <span>
#include <vector>

#include "config/map_reader.hpp"
#include "world/brain_spec.hpp"
#include "world/specs.hpp"

namespace pogosim {

/// The key itself, for messages and the configuration reference.
std::span<Key<RobotSpec> const> brain_keys();

/// `program`, `host`, a firmware, or a map with a script; without the key, a program. Throws ConfigError.
BrainSpec read_brain(MapReader& robot, RobotModel const& model);

/// The keys of a map with a firmware, and of an entry of a script, for the configuration reference.
std::vector<KeyDescription> firmware_map_keys();
std::vector<KeyDescription> script_entry_keys();

}  // namespace pogosim
