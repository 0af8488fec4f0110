// A configuration as it was written, to be quoted in messages and in the metadata of the run.
// Others see a Scenario.
#pragma once

#include "config/scenario.hpp"
#include "config/tree.hpp"

namespace pogosim {

struct ConfigSource {
    Node tree;    // after --set and with one value for each option; unknown keys included
    Node values;  // of each key that means something, defaults included
};

/// Source of a scenario that was built in code: an empty map.
ConfigSource const& source_of(Scenario const& scenario);

/// The entry of `objects` as it is written; nullptr when the scenario was not read from a file.
Node const* node_of(Scenario const& scenario, ObjectConfig const& object);

}  // namespace pogosim
