#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/error.hpp"
#include "base/recent.hpp"
#include "geometry/arena.hpp"
#include "geometry/csv_text.hpp"
#include "geometry/outline_survey.hpp"

namespace pogosim {

namespace {

constexpr std::size_t kMostLines = 1'000'000;

/// Smallest area of a polygon, as a fraction of its bounding box's squared diagonal: below it, it is a line.
constexpr double kThinnest = 1.0e-7;

/// Polygons and, for each corner, the line that it stands on.
struct Drawing {
    std::string name;  // of the file
    std::vector<Polygon> polygons;
    std::vector<std::vector<std::size_t>> lines;
    bool periodic = false;

    std::size_t line_of(EdgeOf edge) const { return lines[edge.polygon][edge.edge]; }
    std::size_t first_line(std::size_t polygon) const { return lines[polygon].front(); }
};

[[noreturn]] void refuse(Drawing const& drawing, std::size_t line, std::string const& message) {
    throw ConfigError(fmt::format("{}:{}: {}", drawing.name, line, message));
}

bool starts_with_letter(std::string_view field) {
    return !field.empty() && std::isalpha(static_cast<unsigned char>(field.front())) != 0;
}

/// What is probably wrong with a line that is not two numbers.
std::string_view advice(std::string_view line, bool is_first) {
    std::vector<std::string> const fields = split_fields(line);
    if (line.find(';') != std::string_view::npos) {
        return "Separate the numbers by a comma, and write decimals with a point";
    }
    if (is_first && std::ranges::all_of(fields, starts_with_letter)) {
        return "An arena file has no header; remove this line";
    }
    if (fields.size() != 2) {
        return "Write one corner a line, with one comma between its coordinates";
    }
    return "Coordinates are finite decimal numbers such as -12.5 or 1e3";
}

/// A coordinate that is also finite in single precision.
std::optional<float> parse_coordinate(std::string_view field) {
    auto const value = parse_number(field);
    if (!value || !std::isfinite(static_cast<float>(*value))) {
        return std::nullopt;
    }
    return static_cast<float>(*value);
}

Vec2 parse_corner(Drawing const& drawing, CsvLine const& line) {
    std::vector<std::string> const fields = split_fields(line.text);
    if (fields.size() == 2) {
        auto const x = parse_coordinate(fields[0]);
        auto const y = parse_coordinate(fields[1]);
        if (x && y) {
            return {*x, *y};
        }
    }
    refuse(drawing, line.number,
           fmt::format("expected a corner 'x,y', found {}. {}", in_quotes(line.text),
                       advice(line.text, drawing.polygons.empty())));
}

void add_corner(Drawing& drawing, Vec2 corner, std::size_t line, bool starts_polygon) {
    if (starts_polygon) {
        drawing.polygons.emplace_back();
        drawing.lines.emplace_back();
    }
    Polygon& polygon = drawing.polygons.back();
    if (polygon.empty() || polygon.back() != corner) {
        polygon.push_back(corner);
        drawing.lines.back().push_back(line);
    }
}

/// "boundary_condition: periodic", as a comment that other readers of the file skip.
bool says_periodic(Drawing const& drawing, CsvLine const& comment) {
    constexpr std::string_view kKey = "boundary_condition:";
    std::string_view text = comment.text;
    if (!text.starts_with(kKey)) {
        return false;
    }
    text.remove_prefix(kKey.size());
    std::string const value = split_fields(text).front();
    if (value != "periodic") {
        refuse(drawing, comment.number,
               fmt::format("expected 'boundary_condition: periodic', found {}. Solid walls need no such line",
                           in_quotes(comment.text)));
    }
    return true;
}

Drawing parse(std::string_view text, std::filesystem::path const& path) {
    Drawing drawing{path.string(), {}, {}, false};
    CsvText const csv = csv_in(text, path);
    for (CsvLine const& comment : csv.comments) {
        drawing.periodic = says_periodic(drawing, comment) || drawing.periodic;
    }
    bool starts_polygon = true;
    for (CsvLine const& line : csv.lines) {
        if (line.number > kMostLines) {
            refuse(drawing, line.number, "an arena file has at most 1000000 lines; draw it with fewer corners");
        }
        if (!line.text.empty()) {
            add_corner(drawing, parse_corner(drawing, line), line.number, starts_polygon);
        }
        starts_polygon = line.text.empty();
    }
    if (drawing.polygons.empty()) {
        throw ConfigError(
            fmt::format("{}: the file has no polygon; expected the corners of an arena, one 'x,y' a line. For a square "
                        "without walls use 'arena_file: arenas/square.csv' and 'boundary_condition: periodic'",
                        drawing.name));
    }
    return drawing;
}

void drop_closing_corners(Drawing& drawing) {
    for (std::size_t p = 0; p < drawing.polygons.size(); ++p) {
        Polygon& polygon = drawing.polygons[p];
        if (polygon.size() > 1 && polygon.back() == polygon.front()) {
            polygon.pop_back();
            drawing.lines[p].pop_back();
        }
    }
}

void check_corner_counts(Drawing const& drawing) {
    for (std::size_t p = 0; p < drawing.polygons.size(); ++p) {
        std::size_t const count = drawing.polygons[p].size();
        if (count < 3) {
            refuse(
                drawing, drawing.first_line(p),
                fmt::format("this polygon has {} different corner{}, and needs at least 3. A blank line ends a polygon",
                            count, count == 1 ? "" : "s"));
        }
    }
}

void check_crossings(Drawing const& drawing, OutlineSurvey const& survey) {
    if (!survey.crossing) {
        return;
    }
    auto const [earlier, later] = *survey.crossing;
    bool const same = earlier.polygon == later.polygon;
    refuse(drawing, drawing.line_of(later),
           fmt::format("{}: the edge that starts here crosses or touches the one that starts on line {}",
                       same ? "this polygon crosses itself" : "two polygons cross", drawing.line_of(earlier)));
}

void check_areas(Drawing const& drawing) {
    for (std::size_t p = 0; p < drawing.polygons.size(); ++p) {
        Box const box = bounding_box(drawing.polygons[p]);
        double const width = static_cast<double>(box.max.x) - box.min.x;
        double const height = static_cast<double>(box.max.y) - box.min.y;
        double const area = std::abs(signed_area(drawing.polygons[p]));
        if (!(area > kThinnest * (width * width + height * height))) {
            refuse(drawing, drawing.first_line(p),
                   "this polygon encloses no area: its corners are on one line, or its loops cancel out");
        }
    }
}

void check_nesting(Drawing const& drawing, OutlineSurvey const& survey) {
    for (std::size_t p = 1; p < drawing.polygons.size(); ++p) {
        auto const parent = survey.parent[p];
        if (!parent) {
            refuse(drawing, drawing.first_line(p),
                   "this hole is outside the outer polygon, which must be the first one of the file");
        }
        if (*parent != 0) {
            refuse(drawing, drawing.first_line(p),
                   fmt::format("this hole is inside the hole that starts on line {}", drawing.first_line(*parent)));
        }
    }
}

ArenaOutline outline_in(std::string_view text, std::filesystem::path const& path) {
    Drawing drawing = parse(text, path);
    drop_closing_corners(drawing);
    check_corner_counts(drawing);
    check_areas(drawing);
    OutlineSurvey const survey = survey_outlines(drawing.polygons);
    check_crossings(drawing, survey);
    check_nesting(drawing, survey);
    return {std::move(drawing.polygons), drawing.name, drawing.periodic};
}

/// A host makes many runs in few arenas, whose files are read each time, but looked through once.
struct KnownOutline {
    std::string text;
    ArenaOutline outline;
};

constexpr std::size_t kMostKnown = 8;
constexpr std::size_t kMostBytes = 1U << 16U;  // of a file: larger ones are not kept in memory

Recent<KnownOutline> known_outlines(kMostKnown);

}  // namespace

bool is_empty_arena_file(std::filesystem::path const& path) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(path, ignored) &&
           std::ranges::all_of(read_csv(path).lines, [](CsvLine const& line) { return line.text.empty(); });
}

ArenaOutline read_arena_file(std::filesystem::path const& path) {
    std::string const text = read_text(path);
    auto const is_this = [&](KnownOutline const& known) {
        return known.outline.source == path.string() && known.text == text;
    };
    if (auto const known = known_outlines.find(is_this)) {
        return known->outline;
    }
    ArenaOutline outline = outline_in(text, path);
    if (text.size() <= kMostBytes) {
        known_outlines.keep(std::make_shared<KnownOutline const>(KnownOutline{.text = text, .outline = outline}),
                            is_this);
    }
    return outline;
}

}  // namespace pogosim
