#include "geometry/formations/heading_column.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

#include "base/escaped.hpp"
#include "base/nearest_name.hpp"

namespace pogosim {

namespace {

constexpr std::string_view kTheta = "theta";
constexpr std::string_view kAngle = "angle";
constexpr std::array<std::string_view, 3> kOtherColumns{"x", "y", "time"};

// How columns of headings begin in files of other programs.
constexpr std::array<std::string_view, 11> kUsualNames{"heading", "orient", "yaw",     "direction", "rotation", "rot",
                                                       "phi",     "psi",    "bearing", "azimuth",   "course"};

bool contains(std::span<std::string const> names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
}

/// Whether a column that is ignored looks as if it were meant: "heading_deg", "Angle", "angel", "theta (rad)".
bool looks_like_heading(std::string_view name) {
    std::string lower(name);
    std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    auto const begins = [&lower](std::string_view usual) { return lower.starts_with(usual); };
    std::array const known{std::string(kAngle), std::string(kTheta)};
    return !nearest_name(lower, known).empty() || std::ranges::any_of(kUsualNames, begins) ||
           std::ranges::any_of(known, [&lower](std::string const& own) {
               return lower.find(own) != std::string::npos || std::ranges::is_permutation(lower, own);
           });
}

/// Columns that are read for nothing.
std::vector<std::string> ignored_columns(std::span<std::string const> names) {
    std::vector<std::string> ignored;
    for (std::string const& name : names) {
        if (!name.empty() && std::ranges::find(kOtherColumns, name) == kOtherColumns.end()) {
            ignored.push_back(fmt::format("'{}'", escaped(name)));
        }
    }
    return ignored;
}

ImportRemark remark_without_headings(std::span<std::string const> names) {
    std::vector<std::string> const ignored = ignored_columns(names);
    if (ignored.empty()) {
        return {};  // a file of positions alone
    }
    std::string const text =
        fmt::format("headings are random, since no column is named 'angle' or 'theta'; {} {} ignored",
                    fmt::join(ignored, ", "), ignored.size() == 1 ? "is" : "are");
    auto const meant = std::ranges::find_if(names, looks_like_heading);
    if (meant == names.end()) {
        return {.text = text};
    }
    return {.text = fmt::format("{}. If '{}' is the heading in radians, name it 'angle'", text, escaped(*meant)),
            .is_warning = true};
}

}  // namespace

HeadingColumn heading_column(std::span<std::string const> names, bool is_data_file) {
    bool const has_angle = contains(names, kAngle);
    if (is_data_file) {
        return has_angle
                   ? HeadingColumn{.name = kAngle}
                   : HeadingColumn{.remark = {.text = "headings are random: the data file has no column 'angle'"}};
    }
    if (contains(names, kTheta)) {
        ImportRemark both{.text = "headings are those of 'theta'; 'angle' is ignored", .is_warning = true};
        return {.name = kTheta, .remark = has_angle ? both : ImportRemark{}};
    }
    return has_angle ? HeadingColumn{.name = kAngle} : HeadingColumn{.remark = remark_without_headings(names)};
}

ImportRemark remark_without_header(std::size_t columns) {
    constexpr std::size_t read = 2;
    if (columns <= read) {
        return {};
    }
    return {.text = fmt::format("only the first two of {} columns are read, as x and y, and headings are random: the "
                                "file has no header. For headings in radians, let it begin with the line x,y,angle",
                                columns),
            .is_warning = true};
}

}  // namespace pogosim
