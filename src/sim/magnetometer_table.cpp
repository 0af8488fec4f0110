#include "sim/magnetometer_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/counted.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/nearest_name.hpp"
#include "geometry/csv_text.hpp"

namespace pogosim {

namespace {

constexpr double kLargestAngle = 1e6;  // in either unit; beyond, turns and more of it may be lost to rounding

/// Places of angle, x, y and z in a line.
using Places = std::array<std::size_t, 1 + kAxisCount>;

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
            throw ConfigError(
                fmt::format("{}:{}: there is no column {} in {}{} Name the columns in magnetometer.csv.columns, or set "
                            "magnetometer.csv.has_header to false",
                            file, line.number, in_quotes(wanted[i]), in_quotes(line.text), near.empty() ? "." : near));
        }
        places[i] = static_cast<std::size_t>(found - names.begin());
    }
    return places;
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
    std::string const found = fmt::format("expected {}, found {}", invalid.expected, in_quotes(invalid.first.text));
    if (!table.skip_invalid_rows) {
        throw ConfigError(fmt::format("{}:{}: {} (magnetometer.csv.skip_invalid_rows: true skips such rows)", file,
                                      invalid.first.number, found));
    }
    log().warn("{}:{}: {}; {} skipped", file, invalid.first.number, found,
               invalid.count == 1 ? "this row is" : fmt::format("{} such rows are", invalid.count));
}

}  // namespace

std::vector<MagneticRow> read_magnetometer_table(std::filesystem::path const& path, MagnetometerTable const& table,
                                                 double field_angle_rad) {
    std::string const file = path.string();
    char const delimiter = table.delimiter.front();
    double const unit = radians_in(table.angle_unit);
    std::optional<Places> places;
    if (!table.has_header) {
        places = places_by_index(table.column_indices);
    }
    std::vector<MagneticRow> rows;
    InvalidRows invalid;
    for (CsvLine const& line : read_csv(path, {.delimiter = delimiter, .comment_prefix = table.comment_prefix}).lines) {
        if (line.text.empty()) {
            continue;
        }
        if (!places) {
            places = places_in_header(file, line, table);
        } else if (auto const numbers = numbers_of(line, *places, delimiter); !numbers) {
            invalid.note(line, "numbers for angle, x, y and z");
        } else if (!is_possible(*numbers)) {
            invalid.note(line, "an angle up to a million and readings of 16 bits, from -32768 to 32767");
        } else {
            auto const [angle, x, y, z] = *numbers;
            rows.push_back({.angle_rad = field_angle_rad - unit * angle, .reading = {x, y, z}});
        }
    }
    report(file, invalid, table);
    return rows;
}

}  // namespace pogosim
