// Metadata that a data file stores about its run.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "config/scenario.hpp"
#include "geometry/arena.hpp"

namespace pogosim {

/// What a run has come to, whatever its configuration says.
struct RunValues {
    std::uint32_t seed = 0;
    double time_step_s = 0.01;     // lowered where robots tick more often
    bool is_periodic = false;      // also where only the arena file says so
    std::string physics_engine{};  // what `auto` stands for
};

/// Schema metadata: program_version, configuration (YAML text of what is written, with the seed in use),
/// resolved_configuration (YAML text of every known key that means something in this run, defaults included), and
/// arena_polygons (YAML list of lists of {x, y}, mm).
std::vector<std::pair<std::string, std::string>> run_metadata(Scenario const& scenario, Arena const& arena,
                                                              RunValues const& run);

}  // namespace pogosim
