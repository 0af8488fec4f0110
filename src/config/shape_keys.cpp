#include "config/shape_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/log.hpp"
#include "config/read_list.hpp"
#include "geometry/hull.hpp"
#include "geometry/outline_survey.hpp"

namespace pogosim {

namespace {

using K = Key<Shape>;
using NamedKinds = NamedValues<ShapeKind>;

constexpr std::string_view kCorners = "a list of 3 to 8 corners, such as [[0, 0], [40, 0], [20, 30]] (mm)";
constexpr std::string_view kParts =
    "a list of maps, such as [{geometry: disk, radius: 20}, {geometry: rectangle, body_width: 60, body_height: 10, "
    "x: 30}]";
constexpr std::size_t kMostParts = 16;
constexpr float kShortestSideMm = 1e-3F;
constexpr float kLargestInMetres = 10.0F;  // corners as far out as this are not in metres; small ones are just near 0
constexpr float kTouchingMm = 0.1F;        // parts of a compound hold together up to this gap

/// What has one outline.
NamedKinds const kConvex{{"disk", ShapeKind::disk},
                         {"rectangle", ShapeKind::rectangle},
                         {"capsule", ShapeKind::capsule},
                         {"triangle", ShapeKind::triangle},
                         {"polygon", ShapeKind::polygon}};

NamedKinds operator+(NamedKinds first, NamedKinds const& rest) {
    first.insert(first.end(), rest.begin(), rest.end());
    return first;
}

K geometry_key(NamedKinds const& kinds, std::string_view doc, bool required) {
    return {"geometry", one_of(&Shape::kind, kinds, {.any_case = true}), any(), "", doc, required};
}

K solid_geometry_key(bool required) {
    return geometry_key(kConvex + NamedKinds{{"compound", ShapeKind::compound}},
                        "Shape of the object; case-insensitive.", required);
}

std::span<K const> size_keys() {
    constexpr auto is_long = [](Shape const& shape) {
        return shape.kind == ShapeKind::rectangle || shape.kind == ShapeKind::capsule;
    };
    static std::array const keys{
        K{"radius", &Shape::radius_mm, kBodyLength, "mm", "Radius of a disk."}.only_if(
            [](Shape const& shape) { return shape.kind == ShapeKind::disk; }),
        K{"body_width", &Shape::width_mm, kBodyLength, "mm", "Size of a rectangle or a capsule along x."}.only_if(
            is_long),
        K{"body_height", &Shape::height_mm, kBodyLength, "mm", "Size of a rectangle or a capsule along y."}.only_if(
            is_long),
        K{"side_length", &Shape::side_length_mm, kBodyLength, "mm",
          "Side of an equilateral triangle, one corner towards -y."}
            .only_if([](Shape const& shape) { return shape.kind == ShapeKind::triangle; }),
        K{"corner_radius", &Shape::corner_radius_mm, between(0, kMaxLength), "mm",
          "Rounds the corners of a rectangle, triangle or polygon, within its sharp corners."}
            .only_if(has_corners),
        K{"corners", Elsewhere{kCorners}, any(), "",
          "Corners of a convex polygon, in order. Its centre of mass is the object's position, wherever the corners "
          "are counted from."}
            .only_if([](Shape const& shape) { return shape.kind == ShapeKind::polygon; }),
    };
    return keys;
}

std::span<K const> part_list_keys() {
    static std::array const keys{
        K{"parts", Elsewhere{kParts}, any(), "",
          "Convex parts of a compound, 1 to 16, which overlap or touch; see their table. Its centre of mass is the "
          "object's position. Overlapping areas count twice towards the mass."}
            .only_if([](Shape const& shape) { return shape.kind == ShapeKind::compound; }),
    };
    return keys;
}

/// A corner in the middle of a side leaves no room to be rounded.
void drop_corners_in_sides(Polygon& corners) {
    constexpr float kStraightMm = 1e-3F;
    for (std::size_t i = 0; i < corners.size() && corners.size() > 3;) {
        Vec2 const before = corners[(i + corners.size() - 1) % corners.size()];
        Vec2 const after = corners[(i + 1) % corners.size()];
        if (length(nearest_on_segment(before, after, corners[i]) - corners[i]) < kStraightMm) {
            corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(i));
        } else {
            ++i;
        }
    }
}

Polygon read_corners(Place const& place) {
    std::vector<Node> const& items = place.node.items;
    if (items.size() < 3 || items.size() > kMostCorners) {
        fail_expected(place, kCorners);
    }
    Polygon corners;
    float largest_mm = 0.0F;
    for (Node const& item : items) {
        Place const corner{item, fmt::format("{}.{}", place.path, corners.size())};
        read_value(corner, {kCoordinate, "mm"}, corners.emplace_back());
        largest_mm = std::max({largest_mm, std::abs(corners.back().x), std::abs(corners.back().y)});
    }
    if (largest_mm < kLargestInMetres) {
        UnitSlips slips;
        slips.look_at(place, {kCoordinate, "mm"});
        slips.warn();
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (length(corners[(i + 1) % corners.size()] - corners[i]) < kShortestSideMm) {
            fail_at(place, fmt::format("corners {} and {} are the same", i, (i + 1) % corners.size()));
        }
    }
    if (signed_area(corners) == 0.0) {
        fail_at(place, "these corners enclose no area");
    }
    if (survey_outlines({&corners, 1}).crossing) {
        fail_at(place, "the sides of this polygon cross or touch each other; list its corners in order, each once");
    }
    if (signed_area(corners) < 0.0) {
        std::ranges::reverse(corners);
    }
    drop_corners_in_sides(corners);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        Vec2 const before = corners[i] - corners[(i + corners.size() - 1) % corners.size()];
        Vec2 const after = corners[(i + 1) % corners.size()] - corners[i];
        if (cross(before, after) < 0.0F) {
            fail_at(place,
                    fmt::format("the polygon is not convex at ({:g}, {:g}); build such a body from convex parts, "
                                "with geometry: compound",
                                corners[i].x, corners[i].y));
        }
    }
    return corners;
}

/// What stands under a key of another shape is not read, but it has to be a list.
void require_list(MapReader const& reader, std::string_view key, std::string_view expected) {
    Node const* const list = reader.find(key);
    if (list != nullptr && list->kind != Node::Kind::sequence) {
        fail_expected({*list, reader.path_of(key)}, expected);
    }
}

/// Warns of a size that is that of another shape, where one of the shape's own is left to its default.
void look_at_sizes(MapReader const& reader, Shape const& shape) {
    if (shape.kind == ShapeKind::polygon) {
        return;  // has no default
    }
    Node const* other = nullptr;
    std::string_view name;  // of the other one's key
    std::vector<std::string_view> missing;
    float default_mm = 0.0F;
    for (K const& key : size_keys()) {
        if (key.name == "corner_radius") {
            continue;  // sharp corners are meant where it is missing
        }
        Node const* const given = reader.find(key.name);
        bool const is_own = key.has_effect(shape);
        if (is_own && given == nullptr) {
            missing.push_back(key.name);
            default_mm = shape.*std::get<float Shape::*>(key.field);
        } else if (!is_own && other == nullptr && given != nullptr) {
            other = given;
            name = key.name;
        }
    }
    if (other != nullptr && !missing.empty()) {
        log().warn("{}: {}: is no size of this shape; {} {} missing, and {:g} mm is taken", other->where(),
                   reader.path_of(name), fmt::join(missing, " and "), missing.size() > 1 ? "are" : "is", default_mm);
    }
}

/// To hundredths, for a message.
float rounded_down(float length_mm) {
    return std::floor(100.0F * length_mm) / 100.0F;
}

/// The sizes of a shape that is no compound.
void read_convex(MapReader& reader, std::span<K const> geometry_keys, Shape& shape) {
    reader.read(geometry_keys, shape);
    reader.read(size_keys(), shape);
    require_list(reader, "corners", kCorners);
    look_at_sizes(reader, shape);
    if (shape.kind == ShapeKind::polygon) {
        Node const* const corners = reader.find("corners");
        if (corners == nullptr) {
            fail_at(reader.place(), fmt::format("needs corners: {}", kCorners));
        }
        shape.corners_mm = read_corners({*corners, reader.path_of("corners")});
    }
    if (has_corners(shape) && shape.corner_radius_mm > largest_corner_radius(shape)) {
        fail_at(
            {*reader.find("corner_radius"), reader.path_of("corner_radius")},
            fmt::format("expected at most {:g} (mm), which leaves some of every side, found {:g}; for half circles, "
                        "use geometry: capsule",
                        rounded_down(largest_corner_radius(shape)), shape.corner_radius_mm));
    }
}

/// A part, and where it is in its compound.
struct WrittenPart {
    float x_mm = 0.0F;
    float y_mm = 0.0F;
    float angle_deg = 0.0F;
};

std::span<Key<WrittenPart> const> part_keys() {
    using P = Key<WrittenPart>;
    static std::array const keys{
        P{"x", &WrittenPart::x_mm, kCoordinate, "mm", "Where the part's centre of mass is, along the heading."},
        P{"y", &WrittenPart::y_mm, kCoordinate, "mm", "The same to the right."},
        P{"angle_deg", &WrittenPart::angle_deg, kDegrees, "degrees",
          "By how much the part is turned, clockwise on the screen."},
    };
    return keys;
}

std::span<K const> part_geometry_keys() {
    static std::array const keys{geometry_key(kConvex, "Shape of the part; case-insensitive.", /*required=*/true)};
    return keys;
}

RoundedPolygon read_part(MapReader& reader) {
    Shape shape;
    WrittenPart written;
    read_convex(reader, part_geometry_keys(), shape);
    reader.read(part_keys(), written);
    Vec2 const offset_mm{written.x_mm, written.y_mm};
    float const turn_rad = written.angle_deg * std::numbers::pi_v<float> / 180.0F;
    return moved(convex_parts(centred(shape)).front(), offset_mm, turn_rad);
}

/// For each part, how far it is from those that hang together with the first one, by gaps of at most kTouchingMm.
std::vector<float> gaps_to_the_first(std::vector<RoundedPolygon> const& parts) {
    std::vector<float> gaps(parts.size(), std::numeric_limits<float>::max());
    std::vector<std::size_t> next{0};
    gaps[0] = 0.0F;
    while (!next.empty()) {
        std::size_t const from = next.back();
        next.pop_back();
        for (std::size_t to = 0; to < parts.size(); ++to) {
            if (gaps[to] > kTouchingMm) {
                gaps[to] = std::min(gaps[to], gap_between_mm(hull_of(parts[from]), hull_of(parts[to])));
                if (gaps[to] <= kTouchingMm) {
                    next.push_back(to);
                }
            }
        }
    }
    return gaps;
}

void read_parts(MapReader& reader, Shape& shape) {
    Node const* const list = reader.find("parts");
    if (list == nullptr) {
        fail_at(reader.place(), fmt::format("needs parts: {}", kParts));
    }
    UnitSlips radians;
    read_list(reader, "parts", kParts, 1, kMostParts, shape.parts, [&](MapReader& part) {
        look_for_radians(part, radians);
        return read_part(part);
    });
    radians.warn();
    std::vector<float> const gaps = gaps_to_the_first(shape.parts);
    auto const loose = std::ranges::find_if(gaps, [](float gap_mm) { return gap_mm > kTouchingMm; });
    if (loose != gaps.end()) {
        auto const number = static_cast<std::size_t>(loose - gaps.begin());
        fail_at(
            {list->items[number], fmt::format("{}.{}", reader.path_of("parts"), number)},
            fmt::format("is not connected to part 0, nor to a part that is: the nearest of these is {:.3g} mm away; "
                        "parts have to overlap or touch",
                        *loose));
    }
}

}  // namespace

void look_for_radians(MapReader const& reader, UnitSlips& slips) {
    constexpr double kFullTurnRad = 6.3;
    for (char const* const key : {"angle_deg", "emission_deg", "reception_deg"}) {
        Node const* const node = reader.find(key);
        std::optional<double> const angle = node == nullptr ? std::nullopt : number_of(*node);
        if (angle && std::trunc(*angle) != *angle) {
            slips.look_at({*node, reader.path_of(key)}, {kDegrees.usually_from(kFullTurnRad), "degrees"});
        }
    }
}

std::span<K const> robot_geometry_keys() {
    static std::array const keys{solid_geometry_key(/*required=*/false)};
    return keys;
}

std::span<K const> solid_geometry_keys() {
    static std::array const keys{solid_geometry_key(/*required=*/true)};
    return keys;
}

std::span<K const> ring_geometry_keys() {
    static std::array const keys{geometry_key(kConvex, "Shape of the object; case-insensitive.", /*required=*/true)};
    return keys;
}

std::span<K const> outline_geometry_keys() {
    static std::array const keys{
        geometry_key(NamedKinds{{"arena", ShapeKind::arena}} + kConvex,
                     "arena: all walls; otherwise the outline of a shape at x and y. Case-insensitive.",
                     /*required=*/true)};
    return keys;
}

std::span<K const> any_geometry_keys() {
    static std::array const keys{
        geometry_key(NamedKinds{{"global", ShapeKind::global}, {"arena", ShapeKind::arena}} + kConvex,
                     "global: everywhere; arena: inside the arena's polygons; otherwise a shape around the centre. "
                     "Case-insensitive.",
                     /*required=*/true)};
    return keys;
}

void read_shape(MapReader& reader, std::span<K const> geometry_keys, Shape& shape) {
    if (!reader.collect([&] { read_convex(reader, geometry_keys, shape); })) {
        shape = {};
    }
    if (shape.kind == ShapeKind::polygon) {
        shape = centred(shape);
    }
}

void read_solid_shape(MapReader& reader, std::span<K const> geometry_keys, Shape& shape) {
    read_shape(reader, geometry_keys, shape);
    reader.read(part_list_keys(), shape);
    reader.collect([&] { require_list(reader, "parts", kParts); });
    if (shape.kind == ShapeKind::compound) {
        shape = reader.collect([&] { read_parts(reader, shape); }) ? centred(shape) : Shape();
    }
}

std::vector<KeyDescription> shape_part_keys() {
    std::vector<KeyDescription> keys = described(part_geometry_keys(), Shape());
    std::ranges::copy(described(size_keys(), Shape()), std::back_inserter(keys));
    std::ranges::copy(described(part_keys(), WrittenPart()), std::back_inserter(keys));
    return keys;
}

}  // namespace pogosim
