#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/counted.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "geometry/csv_text.hpp"
#include "geometry/formations/rows_by_category.hpp"
#include "geometry/formations/task.hpp"

namespace pogosim {

namespace {

/// Where the columns of a csv file are.
struct Columns {
    std::size_t x = 0;
    std::size_t y = 1;
    std::optional<std::size_t> angle;
    std::optional<std::size_t> time;
    std::size_t count = 2;  // fields that a line must have at least
    std::optional<std::size_t> category{};
    std::optional<std::size_t> part{};
};

std::optional<std::size_t> find_column(std::vector<std::string> const& names, std::string_view name,
                                       std::string const& where) {
    if (std::ranges::count(names, name) > 1) {
        throw ConfigError(
            fmt::format("{}: the header has several columns '{}'; rename or remove all but one", where, name));
    }
    auto const found = std::ranges::find(names, name);
    return found == names.end() ? std::nullopt : std::optional<std::size_t>(found - names.begin());
}

bool is_header(std::vector<std::string> const& fields) {
    return std::ranges::any_of(fields, [](std::string_view f) { return !f.empty() && !parse_number(f); });
}

Columns columns_of_header(std::vector<std::string> const& names, std::string const& where, ImportRemark& remark) {
    auto const find = [&](std::string_view name) { return find_column(names, name, where); };
    auto const x = find("x");
    auto const y = find("y");
    if (!x || !y) {
        throw ConfigError(
            fmt::format("{}: expected a header with the columns x and y (and theta or angle, and time, if "
                        "wanted), found {}",
                        where, in_quotes(fmt::format("{}", fmt::join(names, ",")))));
    }
    HeadingColumn const heading = heading_column(names, /*is_data_file=*/find("robot_category").has_value());
    remark = heading.remark;
    return {*x, *y, heading.name.empty() ? std::nullopt : find(heading.name), find("time"), names.size()};
}

double number_in(std::vector<std::string> const& fields, std::size_t column, std::string const& where) {
    auto const number = parse_number(fields[column]);
    if (!number) {
        throw ConfigError(fmt::format("{}: expected a finite number in column {}, found {}", where, column + 1,
                                      in_quotes(fields[column])));
    }
    return *number;
}

ImportedPose parse_pose(std::vector<std::string> const& fields, Columns const& columns, std::size_t row,
                        std::string const& where, SharedNames& categories) {
    if (fields.size() < columns.count) {
        throw ConfigError(
            fmt::format("{}: expected {} fields between commas, found {}", where, columns.count, fields.size()));
    }
    ImportedPose pose;
    pose.x = number_in(fields, columns.x, where);
    pose.y = number_in(fields, columns.y, where);
    pose.row = row;
    bool const is_undirected = columns.category && columns.angle && fields[*columns.angle] == "nan";  // a membrane
    if (columns.angle && !fields[*columns.angle].empty() && !is_undirected) {
        pose.heading_rad = number_in(fields, *columns.angle, where);
    }
    if (columns.time) {
        pose.time_s = number_in(fields, *columns.time, where);
    }
    if (columns.category) {
        pose.category = categories.shared(fields[*columns.category]);
        pose.is_part = columns.part && parse_number(fields[*columns.part]).value_or(-1.0) >= 0.0;
    }
    return pose;
}

ImportedPoses read_csv_poses(std::filesystem::path const& path) {
    ImportedPoses poses;
    bool is_first = true;
    Columns columns;
    SharedNames categories;
    for (CsvLine const& line : read_csv(path).lines) {
        if (line.text.empty()) {
            continue;
        }
        std::string const where = fmt::format("{}:{}", path.string(), line.number);
        std::vector<std::string> const fields = split_fields(line.text);
        bool const header = is_first && is_header(fields);
        if (header) {
            columns = columns_of_header(fields, where, poses.remark);
            columns.category = find_column(fields, "robot_category", where);
            columns.part = find_column(fields, "subpart_id", where);
        } else {
            if (is_first) {
                poses.remark = remark_without_header(fields.size());
            }
            poses.rows.push_back(parse_pose(fields, columns, line.number, where, categories));
        }
        is_first = false;
    }
    return poses;
}

/// Empty if the file cannot be read; opening a pipe would wait for its writer.
std::string first_bytes(std::filesystem::path const& path, std::size_t count) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) {
        return "";
    }
    std::string bytes(count, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(bytes.data(), static_cast<std::streamsize>(count));
    bytes.resize(static_cast<std::size_t>(file.gcount()));
    return bytes;
}

ImportedPoses read_poses(PlacementTask const& task) {
    std::filesystem::path const path = task.spec.filename;
    if (path.empty()) {
        throw FormationError(kFormationKey, "'imported' needs a file: set formation_filename");
    }
    // Files of poses may have any name, so their first bytes say the format.
    std::string const begin = first_bytes(path, 6);
    if (begin.starts_with("PAR1")) {
        throw ConfigError(
            fmt::format("{}: Parquet files cannot be read here; convert it to CSV or Feather", path.string()));
    }
    if (path.extension() != ".feather" && begin != "ARROW1") {
        return read_csv_poses(path);
    }
    if (!task.read_feather) {
        throw ConfigError(fmt::format("{}: Feather files cannot be read here; convert it to CSV", path.string()));
    }
    return task.read_feather(path);
}

constexpr char const* kTimeKey = "formation_time";

/// The times of rows, ascending. Those without one come never.
std::vector<double> times_of(std::vector<ImportedPose> const& poses) {
    std::vector<double> times;
    for (ImportedPose const& pose : poses) {
        if (!std::isnan(pose.time_s) && (times.empty() || times.back() != pose.time_s)) {
            times.push_back(pose.time_s);
        }
    }
    std::ranges::sort(times);
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

/// The time in the file that formation_time names.
double chosen_time_s(FormationSpec const& spec, std::vector<double> const& times) {
    constexpr double tolerance_s = 1e-9;
    if (!spec.time_s) {
        return times.back();
    }
    if (*spec.time_s == 0.0) {
        return times.front();
    }
    if (*spec.time_s < times.front() - tolerance_s || *spec.time_s > times.back() + tolerance_s) {
        std::string const present = times.size() > 1 ? fmt::format("its {} times are from {} to {} s", times.size(),
                                                                   times.front(), times.back())
                                                     : fmt::format("its only time is {} s", times.front());
        throw FormationError(kTimeKey, fmt::format("'{}' has no rows of t = {} s: {}; 'last' takes the last one",
                                                   spec.filename, *spec.time_s, present));
    }
    return *std::prev(std::ranges::upper_bound(times, *spec.time_s + tolerance_s));
}

/// Keeps the rows of the time that is asked for.
void keep_instant(FormationSpec const& spec, std::vector<ImportedPose>& poses) {
    std::vector<double> const times = times_of(poses);
    if (!times.empty()) {
        double const time_s = chosen_time_s(spec, times);
        std::erase_if(poses, [time_s](ImportedPose const& pose) { return pose.time_s != time_s; });
    }
}

/// Maps numbers of the box `imported_min` to `imported_max` onto the arena's bounding box, axis by axis.
class ImportedFrame {
public:
    explicit ImportedFrame(PlacementTask const& task) {
        Vec2 const min = task.spec.imported_min;
        Vec2 const max = task.spec.imported_max;
        float const coordinates[] = {min.x, min.y, max.x, max.y};
        auto const given = std::ranges::count_if(coordinates, [](float c) { return std::isfinite(c); });
        if (given == 0) {
            return;
        }
        if (given < 4 || min.x >= max.x || min.y >= max.y) {
            throw FormationError(
                "imported_formation_min_coords",
                fmt::format("with imported_formation_max_coords, expected the lower and upper corners of a box, "
                            "found ({:g}, {:g}) and ({:g}, {:g})",
                            min.x, min.y, max.x, max.y));
        }
        is_given_ = true;
        source_ = {min, max};
        target_ = task.domain.bounds;
    }

    bool is_given() const { return is_given_; }

    double x_mm(ImportedPose const& pose) const {
        return target_.min.x + (pose.x - source_.min.x) / source_.size().x * target_.size().x;
    }
    double y_mm(ImportedPose const& pose) const {
        return target_.min.y + (pose.y - source_.min.y) / source_.size().y * target_.size().y;
    }
    Vec2 to_mm(ImportedPose const& pose) const {
        return {static_cast<float>(x_mm(pose)), static_cast<float>(y_mm(pose))};
    }

private:
    bool is_given_ = false;
    Box source_{{0.0F, 0.0F}, {1.0F, 1.0F}};
    Box target_{{0.0F, 0.0F}, {1.0F, 1.0F}};
};

bool is_inside(PlacementTask const& task, Vec2 point_mm) {
    return task.periodic ? task.domain.bounds.contains(point_mm) : task.domain.contains(point_mm);
}

struct Unit {
    char const* name;
    float mm;
};
constexpr Unit kMetres{"metres", 1000.0F};
constexpr std::array kUnits{kMetres, Unit{"centimetres", 10.0F}};

/// Whether all numbers of the file would be places of the arena in this unit.
bool fits(PlacementTask const& task, std::vector<Vec2> const& places, Unit const& unit) {
    return std::ranges::all_of(places, [&](Vec2 place) { return is_inside(task, unit.mm * place); });
}

/// How to say that the file has another unit, and which it may be.
std::string remedy(PlacementTask const& task, std::vector<Vec2> const& places) {
    auto const unit = std::ranges::find_if(kUnits, [&](Unit const& own) { return fits(task, places, own); });
    std::string const what =
        unit == kUnits.end() ? "if the file is not in mm," : fmt::format("the file looks like one in {}:", unit->name);
    return what +
           " imported_formation_min_coords and imported_formation_max_coords say which of its coordinates are the "
           "corners of the arena's bounding box";
}

/// Throws when a place is outside, or when all are so near to each other that the unit must be a wrong one.
void check_places(PlacementTask const& task, std::vector<ImportedPose> const& poses, std::vector<Vec2> const& places,
                  ImportedFrame const& frame) {
    bool const has_frame = frame.is_given();
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (std::isnan(places[i].x) || std::isnan(places[i].y)) {
            throw ConfigError(fmt::format("{}:{}: the row has no position (x {:g}, y {:g})", task.spec.filename,
                                          poses[i].row, poses[i].x, poses[i].y));
        }
    }
    auto const outside = [&](Vec2 place) { return !is_inside(task, place); };
    if (auto const first = std::ranges::find_if(places, outside); first != places.end()) {
        auto const count = std::ranges::count_if(places, outside);
        ImportedPose const& pose = poses[static_cast<std::size_t>(first - places.begin())];
        throw ConfigError(fmt::format("{}:{}: the position ({:g}, {:g}) mm is outside the walls of {}{}{}",
                                      task.spec.filename, pose.row, frame.x_mm(pose), frame.y_mm(pose),
                                      arena_text(task.domain),
                                      count > 1 ? fmt::format(", and {} of {} are", count, places.size()) : "",
                                      has_frame ? "" : "; " + remedy(task, places)));
    }
    Vec2 const extent = bounding_box(places).size();
    float const smallest_mm = 2.0F * *std::ranges::min_element(task.radii_mm) / kPlacementMargin;
    bool const all_overlap = places.size() > 1 && std::max(extent.x, extent.y) < smallest_mm;
    if (all_overlap && !has_frame && fits(task, places, kMetres)) {
        throw ConfigError(
            fmt::format("{}: all {} positions are within {:.3g} x {:.3g} mm, less than an object is wide "
                        "({:.4g} mm); {}",
                        task.spec.filename, places.size(), extent.x, extent.y, smallest_mm, remedy(task, places)));
    }
}

void say(PlacementTask const& task, ImportRemark const& remark) {
    if (!remark.text.empty()) {
        log().log(remark.is_warning ? spdlog::level::warn : spdlog::level::info, "{}: {}", task.spec.filename,
                  remark.text);
    }
}

/// Headings are in radians: more than a full turn looks like degrees, as it does in a configuration.
void warn_of_degrees(PlacementTask const& task, std::vector<ImportedPose> const& poses) {
    constexpr double usual_max_rad = 6.3;
    auto const is_large = [](ImportedPose const& pose) { return std::abs(pose.heading_rad) > usual_max_rad; };
    auto const first = std::ranges::find_if(poses, is_large);
    if (first != poses.end()) {
        auto const others = std::ranges::count_if(poses, is_large) - 1;
        log().warn("{}:{}: the angle {:g} rad is unusually large{}; if you meant degrees, write {:.6g}",
                   task.spec.filename, first->row, first->heading_rad,
                   others == 0   ? ""
                   : others == 1 ? ", like that of another row"
                                 : fmt::format(", like those of {} other rows", others),
                   first->heading_rad * std::numbers::pi / 180.0);
    }
}

}  // namespace

std::vector<Placement> place_imported(PlacementTask const& task) {
    ImportedPoses file = read_poses(task);
    std::vector<ImportedPose>& poses = file.rows;
    keep_instant(task.spec, poses);
    sort_by_category(task.spec, poses);
    std::size_t const count = task.radii_mm.size();
    RowsOfOthers const& others = task.spec.rows_of_others;
    std::size_t const needed = count + others.count;
    std::string const what = task.spec.time_s == 0.0 || poses.empty()
                                 ? "rows with the first time value"
                                 : fmt::format("rows of t = {} s", poses.front().time_s);
    if (poses.size() < needed) {
        throw ConfigError(fmt::format("{}: expected at least {} ({}), one for each object, found {}",
                                      task.spec.filename, counted(needed, "pose"), what, poses.size()));
    }
    if (poses.size() > needed && !others.may_follow) {
        log().warn("{}: has {} poses ({}) for {}; the last {} {} ignored", task.spec.filename, poses.size(), what,
                   counted(needed, "object"), poses.size() - needed, poses.size() - needed == 1 ? "is" : "are");
    }
    if (others.count == 0 || others.may_follow) {  // for a file of several tasks, once
        say(task, file.remark);
        warn_of_degrees(task, poses);
    }
    auto const first_of_others = poses.begin() + static_cast<std::ptrdiff_t>(others.first);
    poses.erase(first_of_others, first_of_others + static_cast<std::ptrdiff_t>(others.count));
    poses.resize(count);

    ImportedFrame const frame(task);
    std::vector<Vec2> places;
    std::ranges::transform(poses, std::back_inserter(places),
                           [&](ImportedPose const& pose) { return frame.to_mm(pose); });
    check_places(task, poses, places, frame);
    std::vector<Placement> placements;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        // A heading that the file does not give stays NaN.
        placements.push_back({places[i], wrap_angle(static_cast<float>(poses[i].heading_rad))});
    }
    return placements;
}

}  // namespace pogosim
