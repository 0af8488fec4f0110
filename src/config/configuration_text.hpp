// The configuration of a run as YAML, for the metadata of its data file.
#pragma once

#include <cstdint>
#include <string>

#include "config/scenario.hpp"

namespace pogosim {

/// What a run has come to, whatever its configuration says.
struct RunValues {
    std::uint32_t seed = 0;
    double time_step_s = 0.01;     // lowered where robots tick more often
    bool is_periodic = false;      // also where only the arena file says so
    std::string physics_engine{};  // what `auto` stands for
    float mm_to_pixels = 1.0F;     // scale at which the arena fills the window
};

struct ConfigurationText {
    std::string written;   // what the file and --set say, with the seed in use
    std::string resolved;  // every known key that means something in this run, defaults included
};

ConfigurationText configuration_text(Scenario const& scenario, RunValues const& run);

}  // namespace pogosim
