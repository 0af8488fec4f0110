// What the magnetometers of robots are like, from the configuration and its table.
#pragma once

#include <cstdint>

#include "config/scenario.hpp"
#include "world/magnetometer_spec.hpp"

namespace pogosim {

/// Fits a curve to the table if the configuration asks for it. Throws ConfigError for a table that determines none.
/// `seed`: that of the run.
MagnetometerSpec magnetometers_of(Scenario const& scenario, std::uint32_t seed);

}  // namespace pogosim
