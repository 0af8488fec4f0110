// The arena: an outer polygon and the holes (inner walls) in it, in millimetres, its bounding box at the origin.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geometry/polygon.hpp"

namespace pogosim {

struct Arena {
    std::vector<Polygon> polygons;  // first the outer one, then the holes; mm
    Box bounds;                     // of the outer polygon; mm
    double area_mm2 = 0.0;          // outer polygon less the holes

    Polygon const& outer() const { return polygons.front(); }

    /// Inside the outer polygon and outside every hole.
    bool contains(Vec2 point_mm) const;

    /// Distance to the nearest wall, mm.
    float distance_to_walls(Vec2 point_mm) const;

    friend bool operator==(Arena const&, Arena const&) = default;
};

/// "the arena, which spans (0.0, 0.0) to (1000.0, 1000.0) mm", for messages.
std::string arena_text(Arena const& arena);

/// The arena that these polygons, in mm, enclose; they stay where they are. Throws ConfigError when the outer polygon
/// less the holes has no area.
Arena make_arena(std::vector<Polygon> polygons_mm);

/// Smallest box around the corners of all polygons; there is at least one.
Box bounding_box_of_all(std::vector<Polygon> const& polygons);

/// Polygons as they stand in an arena file, in the file's own unit.
struct ArenaOutline {
    std::vector<Polygon> polygons;  // at least one
    std::string source;             // file name for messages
    bool periodic = false;          // the file says so: a comment "# boundary_condition: periodic"
};

/// Reads a CSV outline: one `x,y` a line, any unit; a blank line ends a polygon; the first polygon is the outer one,
/// the others are holes. Lines that start with '#' are comments. A last corner equal to the first is dropped, and so is
/// one equal to its predecessor. Numbers are decimal with a point; spaces and tabs around them, a byte order mark and
/// every kind of line end are accepted. At most 1e6 lines. Throws ConfigError for a file without a polygon, and naming
/// file and line for text that is not two finite numbers, fewer than 3 corners, repeated corners in a row that leave
/// fewer than 3, no area, a polygon that crosses itself or another, or a hole outside the outer polygon. An unreadable
/// file is a ConfigError too.
ArenaOutline read_arena_file(std::filesystem::path const& path);

/// Whether a file has nothing but blank lines and comments; false for one that is no regular file. Throws ConfigError
/// for a file that cannot be read.
bool is_empty_arena_file(std::filesystem::path const& path);

/// How an outline becomes millimetres.
struct ArenaScaling {
    std::optional<double> surface_mm2{};  // net area asked for, > 0; absent: the outline is in mm
    bool stretch = false;  // map the bounding box to a square first (x and y scaled apart); only with a surface
};

/// Scales the outline so that outer polygon less holes has the asked area, if one is asked for, and moves the top-left
/// corner of the bounding box of all polygons to (0, 0). The outline needs at least one polygon. Throws ConfigError
/// when the net area is not positive.
Arena scale_arena(ArenaOutline const& outline, ArenaScaling const& scaling);

}  // namespace pogosim
