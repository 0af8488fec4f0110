// What a data file says of its run.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "config/scenario.hpp"
#include "geometry/arena.hpp"

namespace pogosim {

/// Schema metadata: program_version, configuration (YAML text of the resolved configuration with the seed in use), and
/// arena_polygons (YAML list of lists of {x, y}, mm).
std::vector<std::pair<std::string, std::string>> run_metadata(Scenario const& scenario, Arena const& arena,
                                                              std::uint32_t seed);

}  // namespace pogosim
