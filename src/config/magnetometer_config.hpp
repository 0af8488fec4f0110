// The map `magnetometer`: what the magnetometers of robots are like, from formulas or from a table of measurements.
#pragma once

#include <array>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>

#include "world/magnetometer_spec.hpp"

namespace pogosim {

enum class MagnetometerSource { procedural, csv };

/// Angles in a file, in terms of the radian.
enum class AngleUnit { degrees, radians };

constexpr double radians_in(AngleUnit unit) {
    return unit == AngleUnit::degrees ? std::numbers::pi / 180.0 : 1.0;
}

/// Which columns of a table hold what.
template <class Column>
struct MagnetometerColumns {
    Column angle;
    Column x;
    Column y;
    Column z;
};

/// A table of readings at known headings, and how a curve is fitted to it.
struct MagnetometerTable {
    std::string file;
    bool has_header = true;
    std::string delimiter = ",";
    std::string comment_prefix = "#";
    MagnetometerColumns<std::string> columns{.angle = "angle", .x = "mag_x", .y = "mag_y", .z = "mag_z"};
    MagnetometerColumns<int> column_indices{.angle = 0, .x = 1, .y = 2, .z = 3};  // without a header
    AngleUnit angle_unit = AngleUnit::degrees;
    int harmonic_order = 2;
    double ridge = 1e-8;
    bool skip_invalid_rows = true;
    bool residual_is_noise = true;            // the error of the fit is added to the noise
    std::optional<double> field_angle_rad{};  // when the table was recorded; absent: that of the world's field
};

struct MagnetometerConfig {
    MagnetometerSource source = MagnetometerSource::procedural;
    AngleUnit angle_unit = AngleUnit::degrees;
    std::optional<std::uint64_t> seed{};  // absent: that of the run
    MagnetometerSpec spec;                // its seed and its fitted curve are not known yet
    MagnetometerTable table;
};

}  // namespace pogosim
