#include "sim/magnetometers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/counted.hpp"
#include "base/error.hpp"
#include "base/exact_math.hpp"
#include "base/log.hpp"
#include "config/find_file.hpp"
#include "config/places.hpp"
#include "sim/magnetometer_doubts.hpp"
#include "sim/magnetometer_fit.hpp"
#include "sim/magnetometer_table.hpp"

namespace pogosim {

namespace {

/// Headings modulo a turn, to about a hundredth of a degree.
std::size_t count_headings(std::vector<MagneticRow> const& rows) {
    constexpr double kDifferent = 1e-4;
    std::set<std::pair<long, long>> places;
    for (MagneticRow const& row : rows) {
        auto const [sine, cosine] = exact::sine_cosine(row.angle_rad);
        places.emplace(std::lround(cosine / kDifferent), std::lround(sine / kDifferent));
    }
    return places.size();
}

MagneticFit fit_to_table(Scenario const& scenario) {
    MagnetometerTable const& table = scenario.magnetometer.table;
    Axes const& field = scenario.magnetometer.spec.field.at_origin;
    std::filesystem::path const file = find_file(scenario, Setting::magnetometer_table, table.file);
    double const field_angle_rad = table.field_angle_rad.value_or(exact::atan2(field[1], field[0]));
    std::string const place = place_of(scenario, Setting::magnetometer_table);
    std::vector<MagneticRow> const rows = read_magnetometer_table(file, table, field_angle_rad);
    auto const fit = fit_magnetic_curve(rows, table.harmonic_order, table.ridge);
    if (!fit) {
        throw ConfigError(fmt::format(
            "{}: '{}' has {} at {}; these cover {:.0f} of 360 degrees, and a curve of harmonic_order {} needs at least "
            "{}, all around the turn.{} Take readings at more headings, or lower magnetometer.csv.harmonic_order",
            place, file.string(), counted(rows.size(), "valid row"), counted(count_headings(rows), "different heading"),
            std::max(0.0, 360.0 - largest_gap_rad(rows) * 180.0 / std::numbers::pi), table.harmonic_order,
            coefficient_count(table.harmonic_order), note_on_unit(rows, table, field_angle_rad)));
    }
    warn_of_doubts(place, file.string(), rows, table, field_angle_rad);
    log().info("magnetometer: {} fitted to {} of '{}'; root mean square of the residuals: x {:.3g}, y {:.3g}, z {:.3g}",
               counted(static_cast<std::size_t>(table.harmonic_order), "harmonic"), counted(rows.size(), "row"),
               file.string(), fit->rms_error[0], fit->rms_error[1], fit->rms_error[2]);
    return *fit;
}

void add_noise(Interval& stddev, double more) {
    stddev = {std::sqrt(stddev.min * stddev.min + more * more), std::sqrt(stddev.max * stddev.max + more * more)};
}

}  // namespace

MagnetometerSpec magnetometers_of(Scenario const& scenario, std::uint32_t seed) {
    MagnetometerConfig const& config = scenario.magnetometer;
    MagnetometerSpec spec = config.spec;
    spec.seed = config.seed.value_or(seed);
    if (config.source == MagnetometerSource::procedural) {
        return spec;
    }
    MagneticFit const fit = fit_to_table(scenario);
    spec.fitted = fit.curve;
    if (config.table.residual_is_noise) {
        add_noise(spec.variation.noise_stddev.x, fit.rms_error[0]);
        add_noise(spec.variation.noise_stddev.y, fit.rms_error[1]);
        add_noise(spec.variation.noise_stddev.z, fit.rms_error[2]);
    }
    return spec;
}

}  // namespace pogosim
