// Metadata that a data file stores about its run.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "config/configuration_text.hpp"
#include "config/scenario.hpp"
#include "geometry/arena.hpp"

namespace pogosim {

/// Schema metadata: program_version, configuration and resolved_configuration (see ConfigurationText), and
/// arena_polygons (YAML list of lists of {x, y}, mm). `run.mm_to_pixels` is found here.
std::vector<std::pair<std::string, std::string>> run_metadata(Scenario const& scenario, Arena const& arena,
                                                              RunValues run);

}  // namespace pogosim
