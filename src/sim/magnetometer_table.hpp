// Tables of magnetometer readings at known headings.
#pragma once

#include <filesystem>
#include <vector>

#include "config/magnetometer_config.hpp"
#include "sim/magnetometer_fit.hpp"

namespace pogosim {

/// Reads the rows; `field_angle_rad` is the direction of the field when they were recorded. Warns once of rows that are
/// not numbers, or that no sensor can have measured. Throws ConfigError for a file that cannot be read, a column that
/// is missing, and rows that must not be skipped.
std::vector<MagneticRow> read_magnetometer_table(std::filesystem::path const& path, MagnetometerTable const& table,
                                                 double field_angle_rad);

}  // namespace pogosim
