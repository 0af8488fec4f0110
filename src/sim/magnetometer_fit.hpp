// The curve of a magnetometer from a table of readings at known angles, and what is doubtful about such a table.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/magnetometer_config.hpp"
#include "world/magnetometer_spec.hpp"

namespace pogosim {

struct MagneticRow {
    double angle_rad = 0.0;  // of the field in the robot's frame
    Axes reading{};          // counts
    std::size_t line = 0;    // of the table, for messages
};

struct MagneticFit {
    MagneticCurve curve;
    Axes rms_error{};  // of the residuals, counts
};

/// Coefficients of a curve with so many harmonics.
constexpr std::size_t coefficient_count(int order) {
    return 1 + 2 * static_cast<std::size_t>(order);
}

/// Ridge regression of each axis on 1, cos(k a) and sin(k a), k = 1 to `order`: minimises the sum of squared residuals
/// plus `ridge` times the sum of squared coefficients, the constant excluded. Nothing if the rows do not determine the
/// coefficients.
std::optional<MagneticFit> fit_magnetic_curve(std::span<MagneticRow const> rows, int order, double ridge);

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
