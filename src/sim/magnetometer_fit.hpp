// The curve of a magnetometer from a table of readings at known angles.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

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

}  // namespace pogosim
