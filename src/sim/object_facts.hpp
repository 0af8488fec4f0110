// What the objects of a run have, for the metadata of its data file: tools see the configuration only, and need not
// know its types.
#pragma once

#include <string>

#include "config/scenario.hpp"
#include "world/world.hpp"

namespace pogosim {

/// For each category, a list with what the objects of each of its entries have, as JSON, which docs/data_file.md
/// describes. `world` is the one that was built of the scenario.
std::string object_facts(Scenario const& scenario, World const& world);

}  // namespace pogosim
