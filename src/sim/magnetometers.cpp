#include "sim/magnetometers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "base/counted.hpp"
#include "base/error.hpp"
#include "base/exact_math.hpp"
#include "base/input_hash.hpp"
#include "base/log.hpp"
#include "base/nearest_name.hpp"
#include "config/find_file.hpp"
#include "config/magnetometer_config.hpp"
#include "config/places.hpp"
#include "geometry/csv_text.hpp"
#include "sim/magnetometer_fit.hpp"

namespace pogosim {

namespace {

// Tables of magnetometer readings at known headings.

constexpr double kLargestAngle = 1e6;  // in either unit; beyond, turns and more of it may be lost to rounding

/// Places of angle, x, y and z in a line.
using Places = std::array<std::size_t, 1 + kAxisCount>;

/// The delimiter with which a line has enough fields, if it does not have them with this one.
std::optional<char> other_delimiter(std::string const& line, char delimiter) {
    constexpr std::string_view kUsual = ";\t,|";
    constexpr std::size_t kFields = std::tuple_size_v<Places>;
    auto const found = std::ranges::find_if(
        kUsual, [&](char other) { return other != delimiter && split_fields(line, other).size() >= kFields; });
    bool const is_enough = split_fields(line, delimiter).size() >= kFields;
    return is_enough || found == kUsual.end() ? std::nullopt : std::optional(*found);
}

std::string in_yaml(char delimiter) {
    return delimiter == '\t' ? "\"\\t\"" : fmt::format("\"{}\"", delimiter);
}

/// What to do about a first line that does not name the columns.
std::string header_advice(std::string const& line, std::vector<std::string> const& names, char delimiter) {
    if (auto const other = other_delimiter(line, delimiter)) {
        return fmt::format("Set magnetometer.csv.delimiter to {}", in_yaml(*other));
    }
    if (std::ranges::all_of(names, [](std::string const& name) { return parse_number(name).has_value(); })) {
        return "These are numbers: set magnetometer.csv.has_header to false";
    }
    std::string const names_of_all =
        names.size() == std::tuple_size_v<Places>
            ? fmt::format(", perhaps as {{angle: {}, x: {}, y: {}, z: {}}}", in_quotes(names[0]), in_quotes(names[1]),
                          in_quotes(names[2]), in_quotes(names[3]))
            : "";
    return fmt::format("Name the columns in magnetometer.csv.columns{}", names_of_all);
}

/// What may be wrong with a line that has no numbers; empty if that cannot be known.
std::string row_advice(std::string const& line, char delimiter) {
    if (auto const other = other_delimiter(line, delimiter)) {
        return fmt::format(" (perhaps magnetometer.csv.delimiter: {})", in_yaml(*other));
    }
    bool const has_comma = std::ranges::any_of(split_fields(line, delimiter), [](std::string field) {
        std::size_t const comma = field.find(',');
        if (comma == std::string::npos) {
            return false;
        }
        field[comma] = '.';
        return parse_number(field).has_value();
    });
    return has_comma ? " (write 0.5 for 0,5)" : "";
}

Places places_in_header(std::string const& file, CsvLine const& line, MagnetometerTable const& table) {
    std::vector<std::string> const names = split_fields(line.text, table.delimiter.front());
    auto const& [angle, x, y, z] = table.columns;
    std::array const wanted{angle, x, y, z};
    Places places{};
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        auto const found = std::ranges::find(names, wanted[i]);
        if (found == names.end()) {
            std::vector<std::string> others;  // that have no use yet
            std::ranges::copy_if(names, std::back_inserter(others), [&](std::string const& name) {
                return std::ranges::find(wanted, name) == wanted.end();
            });
            std::string const near = did_you_mean(wanted[i], others);
            throw ConfigError(fmt::format("{}:{}: there is no column {} in {}{} {}", file, line.number,
                                          in_quotes(wanted[i]), in_quotes(line.text), near.empty() ? "." : near,
                                          header_advice(line.text, names, table.delimiter.front())));
        }
        places[i] = static_cast<std::size_t>(found - names.begin());
    }
    return places;
}

/// Warns of columns that cannot be told apart, or that are one.
void look_for_doubtful_columns(std::string const& file, std::vector<std::string> const& names, Places const& places) {
    constexpr std::array kMeanings{"angle", "x", "y", "z"};
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (places[i] < names.size() && std::ranges::count(names, names[places[i]]) > 1) {
            log().warn("{}: the column {} stands there several times; the first one is read", file,
                       in_quotes(names[places[i]]));
        }
        for (std::size_t j = 0; j < i; ++j) {
            if (places[i] == places[j]) {
                log().warn("{}: {} and {} are read from the same column, number {} from 0 on (magnetometer.csv)", file,
                           kMeanings[j], kMeanings[i], places[i]);
            }
        }
    }
}

Places places_by_index(MagnetometerColumns<int> const& columns) {
    auto const place = [](int index) { return static_cast<std::size_t>(index); };
    return {place(columns.angle), place(columns.x), place(columns.y), place(columns.z)};
}

/// Nothing if one of its fields is missing or no number.
std::optional<std::array<double, 1 + kAxisCount>> numbers_of(CsvLine const& line, Places const& places,
                                                             char delimiter) {
    std::vector<std::string> const fields = split_fields(line.text, delimiter);
    std::array<double, 1 + kAxisCount> numbers{};
    for (std::size_t i = 0; i < places.size(); ++i) {
        std::optional<double> const number = places[i] < fields.size() ? parse_number(fields[places[i]]) : std::nullopt;
        if (!number) {
            return std::nullopt;
        }
        numbers[i] = *number;
    }
    return numbers;
}

/// Whether a sensor can have measured this: larger numbers are those of a damaged table, and fit no curve.
bool is_possible(std::array<double, 1 + kAxisCount> const& numbers) {
    using Count = std::numeric_limits<std::int16_t>;
    auto const [angle, x, y, z] = numbers;
    auto const is_count = [](double reading) { return reading >= Count::min() && reading <= Count::max(); };
    return std::abs(angle) <= kLargestAngle && is_count(x) && is_count(y) && is_count(z);
}

/// Rows that are no data.
struct InvalidRows {
    std::size_t count = 0;
    CsvLine first{};
    std::string_view expected;  // in the first one

    void note(CsvLine const& line, std::string_view expected_here) {
        if (count++ == 0) {
            first = line;
            expected = expected_here;
        }
    }
};

void report(std::string const& file, InvalidRows const& invalid, MagnetometerTable const& table) {
    if (invalid.count == 0) {
        return;
    }
    std::string const found = fmt::format("expected {}, found {}{}", invalid.expected, in_quotes(invalid.first.text),
                                          row_advice(invalid.first.text, table.delimiter.front()));
    if (!table.skip_invalid_rows) {
        throw ConfigError(fmt::format("{}:{}: {} (magnetometer.csv.skip_invalid_rows: true skips such rows)", file,
                                      invalid.first.number, found));
    }
    log().warn("{}:{}: {}; {} skipped", file, invalid.first.number, found,
               invalid.count == 1 ? "this row is" : fmt::format("{} such rows are", invalid.count));
}

/// Reads the rows; `field_angle_rad` is the direction of the field when they were recorded. Warns once of rows that are
/// not numbers, or that no sensor can have measured. Throws ConfigError for a file that cannot be read, a column that
/// is missing, and rows that must not be skipped.
std::vector<MagneticRow> read_magnetometer_table(std::filesystem::path const& path, MagnetometerTable const& table,
                                                 double field_angle_rad) {
    std::string const file = path.string();
    char const delimiter = table.delimiter.front();
    double const unit = radians_in(table.angle_unit);
    std::optional<Places> places;
    if (!table.has_header) {
        places = places_by_index(table.column_indices);
        look_for_doubtful_columns(file, {}, *places);
    }
    std::vector<MagneticRow> rows;
    InvalidRows invalid;
    std::string const text = read_text(path);
    InputHash::note(text);
    for (CsvLine const& line :
         csv_in(text, path, {.delimiter = delimiter, .comment_prefix = table.comment_prefix}).lines) {
        if (line.text.empty()) {
            continue;
        }
        if (!places) {
            places = places_in_header(file, line, table);
            look_for_doubtful_columns(file, split_fields(line.text, delimiter), *places);
        } else if (auto const numbers = numbers_of(line, *places, delimiter); !numbers) {
            invalid.note(line, "numbers for angle, x, y and z");
        } else if (!is_possible(*numbers)) {
            invalid.note(line, "an angle up to a million and readings of 16 bits, from -32768 to 32767");
        } else {
            auto const [angle, x, y, z] = *numbers;
            rows.push_back({.angle_rad = field_angle_rad - unit * angle, .reading = {x, y, z}, .line = line.number});
        }
    }
    report(file, invalid, table);
    return rows;
}

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
