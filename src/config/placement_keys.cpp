#include "config/object_parts.hpp"

#include <fmt/format.h>

#include <array>

#include "config/lamp_keys.hpp"
#include "config/shape_keys.hpp"
#include "geometry/outline_survey.hpp"

namespace pogosim {

namespace {

constexpr std::string_view kArea = "a map of x, y and radius, or a list of at least 3 corners [x, y] (mm)";
constexpr std::string_view kPose = "[x, y] or [x, y, angle] (mm, rad)";
constexpr std::string_view kPoses = "a list of [x, y] or [x, y, angle] (mm, rad)";

std::span<Key<ObjectConfig> const> placement_keys() {
    using K = Key<ObjectConfig>;
    static std::array const keys{
        K{"poses", Elsewhere{kPoses}, any(), "",
          "Initial pose of each object, in order; replaces x and y. Default angle: 0. nb may be omitted."},
        K{"area", Elsewhere{kArea}, any(), "",
          "Region of the arena in which the formation places this category, before those without an area."},
    };
    return keys;
}

std::span<Key<OwnFormation> const> formation_keys() {
    NamedValues<std::optional<std::string>> names;
    for (std::string const& name : formation_names()) {
        if (name != kImportedFormation) {
            names.emplace_back(name, name);
        }
    }
    static std::array const keys{
        Key<OwnFormation>{
            "initial_formation", one_of(&OwnFormation::name, names), any(), "",
            "Formation of this category alone, placed before the others; default: the top-level formation."},
    };
    return keys;
}

struct Disk {
    float x_mm = 0.0F;
    float y_mm = 0.0F;
    float radius_mm = 0.0F;
};

std::span<Key<Disk> const> disk_keys() {
    using K = Key<Disk>;
    constexpr bool required = true;
    static std::array const keys{
        K{"x", &Disk::x_mm, kCoordinate, "mm", "Centre.", required},
        K{"y", &Disk::y_mm, kCoordinate, "mm", "Centre.", required},
        K{"radius", &Disk::radius_mm, above(0).up_to(kMaxLength), "mm", "Radius.", required},
    };
    return keys;
}

/// The numbers of a list, at least `least` and at most `most` of them.
std::vector<float> read_numbers(Place const& place, std::size_t least, std::size_t most, std::string_view expected,
                                UnitSlips& slips) {
    std::size_t const count = place.node.items.size();
    if (place.node.kind != Node::Kind::sequence || count < least || count > most) {
        fail_expected(place, expected);
    }
    std::vector<float> numbers(count);
    for (std::size_t i = 0; i < count; ++i) {
        Limits const limits = i < 2 ? Limits{kCoordinate, "mm"} : Limits{kAngle, "rad"};
        Place const number{place.node.items[i], fmt::format("{}.{}", place.path, i)};
        read_value(number, limits, numbers[i]);
        slips.look_at(number, limits);
    }
    return numbers;
}

std::vector<Placement> read_poses(Place const& place) {
    if (place.node.kind != Node::Kind::sequence) {
        fail_expected(place, kPoses);
    }
    if (place.node.items.empty()) {
        fail_at(place, "the list is empty; specify one pose per object, or omit the key");
    }
    std::vector<Placement> poses;
    UnitSlips slips;
    for (Node const& item : place.node.items) {
        std::vector<float> const numbers =
            read_numbers({item, fmt::format("{}.{}", place.path, poses.size())}, 2, 3, kPose, slips);
        poses.push_back({{numbers[0], numbers[1]}, numbers.size() == 3 ? wrap_angle(numbers[2]) : 0.0F});
    }
    slips.warn();
    return poses;
}

Polygon read_polygon_area(Place const& place) {
    if (place.node.kind != Node::Kind::sequence || place.node.items.size() < 3) {
        fail_expected(place, kArea);
    }
    Polygon corners;
    UnitSlips slips;
    for (Node const& item : place.node.items) {
        std::vector<float> const numbers =
            read_numbers({item, fmt::format("{}.{}", place.path, corners.size())}, 2, 2, "a corner [x, y] (mm)", slips);
        corners.push_back({numbers[0], numbers[1]});
    }
    slips.warn();
    if (signed_area(corners) == 0.0) {
        fail_at(place, "these corners enclose no area");
    }
    if (survey_outlines({&corners, 1}).crossing) {
        fail_at(place, "the sides of this polygon cross or touch each other; list its corners in order, each once");
    }
    return corners;
}

Polygon read_area(MapReader const& object, Node const& node) {
    Place const place{node, object.path_of("area")};
    if (node.kind != Node::Kind::map) {
        return read_polygon_area(place);
    }
    MapReader reader(node, place.path, object.reading());
    Polygon const area = read_disk_area(reader);
    reader.finish();
    return area;
}

/// Two keys that place objects in different ways are a mistake. Returns whether both are there.
bool refuse_both(MapReader const& reader, std::string_view one, std::string_view other) {
    bool const are_there = reader.find(one) != nullptr && reader.find(other) != nullptr;
    if (are_there) {
        reader.refuse(one, fmt::format("cannot be combined with '{}'; use one or the other", other));
    }
    return are_there;
}

void refuse_fixed_wheels_and_membranes(MapReader const& reader, ObjectConfig const& object) {
    bool const has_wheels = object.spec.robot && object.spec.robot->model.has_motors();
    if (object.spec.body && object.spec.body->fixed && (has_wheels || object.spec.membrane)) {
        reader.refuse("body_fixed",
                      fmt::format("{} cannot be fixed; use a passive_object, an active_object or a pogobject",
                                  has_wheels ? "a robot with wheels" : "a membrane"));
    }
}

}  // namespace

Polygon read_disk_area(MapReader& reader) {
    Disk disk;
    reader.read(disk_keys(), disk);
    return moved(outline({.kind = ShapeKind::disk, .radius_mm = disk.radius_mm}), {disk.x_mm, disk.y_mm}, 0.0F);
}

void read_placement(MapReader& reader, ObjectConfig& object) {
    refuse_fixed_wheels_and_membranes(reader, object);
    bool has_place_twice = false;
    for (std::string_view const key : {"poses", "area", "initial_formation"}) {
        bool const has_x = refuse_both(reader, key, "x");
        has_place_twice = refuse_both(reader, key, "y") || has_x || has_place_twice;
    }
    refuse_both(reader, "area", "poses");
    refuse_both(reader, "initial_formation", "poses");
    if (has_place_twice) {
        ignore_position(reader);
    } else {
        read_position(reader, object);
    }
    reader.read(placement_keys(), object);
    reader.read(formation_keys(), object.own_formation);
    if (Node const* area = reader.find("area")) {
        reader.collect([&] { object.own_formation.area_mm = read_area(reader, *area); });
    }
    Node const* const poses = reader.find("poses");
    if (poses == nullptr || !reader.collect([&] { object.poses = read_poses({*poses, reader.path_of("poses")}); })) {
        return;
    }
    Node const* const nb = reader.find("nb");
    auto const count = static_cast<int>(object.poses.size());
    if (nb != nullptr && number_of(*nb) && object.nb != count) {
        reader.refuse("nb",
                      fmt::format("expected {}, the number of poses, found {}; nb may be omitted", count, object.nb));
    }
    object.nb = count;
}

}  // namespace pogosim
