// What is doubtful about a table of magnetometer readings, though a curve can be fitted to it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "config/magnetometer_config.hpp"
#include "sim/magnetometer_fit.hpp"

namespace pogosim {

/// The largest angle between neighbouring headings around the turn, rad; a whole turn if there is at most one.
double largest_gap_rad(std::span<MagneticRow const> rows);

/// " ...": what to do if the angles of the table seem to be in another unit than it says; empty if not.
std::string note_on_unit(std::span<MagneticRow const> rows, MagnetometerTable const& table, double field_angle_rad);

/// The rows whose readings are far from the curve of the others; none if too many are, so that the curve is wrong.
std::vector<MagneticRow> outliers_of(std::span<MagneticRow const> rows, int order, double ridge);

/// Warns of headings on one side only, of readings that do not go around an ellipse or do so the other way than those
/// of the model with formulas, and of outliers. `place`: of the key that names the file.
void warn_of_doubts(std::string const& place, std::string const& file, std::span<MagneticRow const> rows,
                    MagnetometerTable const& table, double field_angle_rad);

}  // namespace pogosim
