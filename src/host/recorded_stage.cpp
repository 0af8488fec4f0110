#include "host/recorded_stage.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "base/error.hpp"
#include "config/map_reader.hpp"
#include "config/scenario_keys.hpp"
#include "config/shape_keys.hpp"
#include "config/tree.hpp"

namespace pogosim {

namespace {

constexpr std::string_view kPath = "description";
constexpr std::string_view kList = "a list";
constexpr int kMostCells = 10000;  // of the light map, in a row or a column

enum class Role { body, robot, wall, membrane, robot_membrane };

/// How the objects of one kind look.
struct DrawnKind {
    Role role = Role::body;
    bool segments = false;
    float half_thickness_mm = 10.0F;
    float x_mm = 0.0F;
    float y_mm = 0.0F;
    Shape shape;

    bool is_membrane() const { return role == Role::membrane || role == Role::robot_membrane; }
    bool runs_program() const { return role != Role::body && role != Role::membrane; }
};

std::span<Key<DrawnKind> const> kind_keys() {
    using K = Key<DrawnKind>;
    static std::array const keys{
        K{"is",
          one_of(&DrawnKind::role, {{"body", Role::body},
                                    {"robot", Role::robot},
                                    {"wall", Role::wall},
                                    {"membrane", Role::membrane},
                                    {"robot_membrane", Role::robot_membrane}}),
          any(), "", "What it is."},
        K{"segments", &DrawnKind::segments, any(), "", "Whether a membrane is a band."},
        K{"half_thickness", &DrawnKind::half_thickness_mm, kLengthOrZero, "mm", "Half of the thickness of a membrane."},
        K{"x", &DrawnKind::x_mm, kCoordinate, "mm", "Place of a wall."},
        K{"y", &DrawnKind::y_mm, kCoordinate, "mm", "Place of a wall."},
    };
    return keys;
}

DrawnKind read_kind(MapReader& reader) {
    DrawnKind kind;
    reader.read(kind_keys(), kind);
    if (kind.role == Role::wall) {
        read_shape(reader, outline_geometry_keys(), kind.shape);
    } else if (!kind.is_membrane()) {
        read_solid_shape(reader, solid_geometry_keys(), kind.shape);
    }
    reader.finish();
    return kind;
}

struct Cells {
    int columns = 1;
    int rows = 1;
};

struct Description {
    bool periodic = false;
    bool leds = true;
    Cells light_map;
    std::vector<DrawnKind> kinds;
    std::vector<Shape> lamps;
    ViewOptions view;
};

std::span<Key<Description> const> description_keys() {
    using K = Key<Description>;
    static std::array const keys{
        K{"periodic", &Description::periodic, any(), "", "No walls."},
        K{"leds", &Description::leds, any(), "", "Colours are those of LEDs."},
        K{"kinds", Elsewhere{kList}, any(), "", "How objects look."},
        K{"lamps", Elsewhere{kList}, any(), "", "What each lamp can light."},
        K{"view", Elsewhere{kMapOfKeysBelow}, any(), "", "Keys of the run's configuration."},
        K{"options", Elsewhere{kMapOfKeysBelow}, any(), "", "Keys of `view` that prevail over these."},
    };
    return keys;
}

std::span<Key<Cells> const> cell_keys() {
    static std::array const keys{
        Key<Cells>{"columns", &Cells::columns, between(1, kMostCells), "", "Cells in a row."},
        Key<Cells>{"rows", &Cells::rows, between(1, kMostCells), "", "Cells in a column."},
    };
    return keys;
}

template <class T, class Read>
std::vector<T> read_each(MapReader const& reader, std::string_view key, Read const& read) {
    std::vector<T> parts;
    if (Node const* const list = reader.find(key)) {
        for (Node const& item : list->items) {
            MapReader inner(item, fmt::format("{}.{}", reader.path_of(key), parts.size()), reader.reading());
            parts.push_back(read(inner));
        }
    }
    return parts;
}

Description read_description(char const* text) {
    Node const root = parse_yaml(text, std::string(kPath));
    Reading reading;
    reading.strict_keys = true;
    Description description;
    MapReader reader(root, "", reading);
    reader.read(description_keys(), description);
    reader.read_map("light_map", [&](MapReader& map) { map.read(cell_keys(), description.light_map); });
    description.kinds = read_each<DrawnKind>(reader, "kinds", read_kind);
    description.lamps = read_each<Shape>(reader, "lamps", [](MapReader& lamp) {
        Shape shape;
        read_shape(lamp, any_geometry_keys(), shape);
        lamp.finish();
        return shape;
    });
    if (Node const* const view = reader.find("view")) {
        reading.strict_keys = false;  // it may be a configuration for another version
        MapReader keys(*view, "", reading);
        ViewConfig config;
        read_view(keys, config);
        description.view = config;
        reading.strict_keys = true;
    }
    if (Node const* const options = reader.find("options")) {
        MapReader keys(*options, "view", reading);
        read_view_map(keys, description.view);
        keys.finish();
    }
    reader.finish();
    reading.problems.throw_if_any();
    return description;
}

Arena read_arena(pogosim_stage const& stage) {
    if (stage.polygon_count == 0) {
        throw ConfigError("polygon_count: expected at least 1, the outer wall");
    }
    Arena arena;
    float const* corner_mm = stage.corners_mm;
    for (std::uint32_t const count : std::span(stage.corner_counts, stage.polygon_count)) {
        if (count < 3) {
            throw ConfigError(fmt::format("corner_counts: a polygon has at least 3 corners, found {}", count));
        }
        Polygon& polygon = arena.polygons.emplace_back();
        for (std::uint32_t i = 0; i < count; ++i, corner_mm += 2) {
            polygon.push_back({corner_mm[0], corner_mm[1]});
        }
    }
    arena.bounds = bounding_box(arena.outer());
    return arena;
}

Category category_of(DrawnKind const& kind) {
    Category category;
    category.spec.shape = kind.shape;
    if (kind.runs_program()) {
        category.spec.robot.emplace();
    }
    if (kind.is_membrane()) {
        category.spec.membrane = MembraneSpec{.segments = kind.segments,
                                              .radius_mm = kind.half_thickness_mm,
                                              .thickness_mm = 2.0F * kind.half_thickness_mm};
    }
    return category;
}

void add_body(Scenery& scenery, Shape const& shape) {
    scenery.body_shape.push_back(shape);
    scenery.body_radius_mm.push_back(bounding_radius(shape));
}

void add_object(Scenery& scenery, DrawnKind const& kind, Object object, std::uint32_t parts) {
    if (kind.role != Role::wall && (!kind.is_membrane() || parts > 0)) {
        object.body = static_cast<std::uint32_t>(scenery.body_shape.size());
        object.body_count = kind.is_membrane() ? parts : 1;
        Shape const dot{.kind = ShapeKind::disk, .radius_mm = kind.half_thickness_mm};
        for (std::uint32_t i = 0; i < object.body_count; ++i) {
            add_body(scenery, kind.is_membrane() ? dot : kind.shape);
        }
    }
    if (kind.runs_program()) {
        object.robot = static_cast<std::uint32_t>(scenery.robot_id.size());
        scenery.robot_id.push_back(object.id);
        scenery.robot_body.push_back(object.body);
        scenery.robot_category.push_back(object.category);
    }
    if (kind.role == Role::wall) {
        Outline line{.robot = object.robot, .polygons = {}};
        for (Polygon const& part : outlines(kind.shape)) {
            line.polygons.push_back(moved(part, {kind.x_mm, kind.y_mm}, 0.0F));
        }
        scenery.outlines.push_back(std::move(line));
        if (kind.shape.kind == ShapeKind::arena) {
            scenery.outlines.back().polygons = scenery.arena.polygons;
        }
    }
    scenery.objects.push_back(object);
}

}  // namespace

RecordedStage read_stage(pogosim_stage const& stage) {
    Description description = read_description(stage.description);
    Scenery scenery;
    scenery.arena = read_arena(stage);
    scenery.periodic = description.periodic;
    for (DrawnKind const& kind : description.kinds) {
        scenery.categories.push_back(category_of(kind));
    }
    RecordedStage read{.scenery = nullptr,
                       .view = description.view,
                       .shows_leds = description.leds,
                       .light_columns = description.light_map.columns,
                       .light_rows = description.light_map.rows,
                       .lamps = std::move(description.lamps)};
    for (std::size_t i = 0; i < stage.object_count; ++i) {
        std::uint32_t const number = stage.kinds[i];
        if (number >= description.kinds.size()) {
            throw ConfigError(fmt::format("kinds: object {} is of kind {}, and there are {} kinds", i, number,
                                          description.kinds.size()));
        }
        DrawnKind const& kind = description.kinds[number];
        if (stage.part_counts[i] > 0 && !kind.is_membrane()) {
            throw ConfigError(
                fmt::format("part_counts: object {} has {} parts, but is no membrane", i, stage.part_counts[i]));
        }
        if (stage.part_counts[i] == 1) {
            throw ConfigError(fmt::format("part_counts: a membrane has at least 2 parts, or none; object {} has 1", i));
        }
        add_object(scenery, kind, {.id = stage.ids[i], .category = number}, stage.part_counts[i]);
    }
    read.scenery = std::make_shared<Scenery const>(std::move(scenery));
    return read;
}

}  // namespace pogosim
