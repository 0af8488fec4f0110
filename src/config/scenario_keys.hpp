// Tables of the top-level keys.
#pragma once

#include <span>

#include "config/key.hpp"
#include "config/map_reader.hpp"
#include "config/scenario.hpp"

namespace pogosim {

/// Fills everything but objects, parameters and resolved.
void read_top_level(MapReader& reader, Scenario& scenario);

}  // namespace pogosim
