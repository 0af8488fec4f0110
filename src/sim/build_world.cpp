#include "sim/build_world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/counted.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/memory.hpp"
#include "config/find_file.hpp"
#include "config/places.hpp"
#include "config/range.hpp"
#include "device/set_up.hpp"
#include "interface/pogobase_inside.hpp"
#include "light/lighting.hpp"
#include "physics/coinciding_centres.hpp"
#include "sim/magnetometers.hpp"
#include "sim/make_links.hpp"
#include "sim/make_membrane.hpp"
#include "sim/place_objects.hpp"
#include "sim/standing_objects.hpp"
#include "world/assert_world.hpp"

namespace pogosim {

namespace {

std::string size_text(Box const& box) {
    return fmt::format("{:.1f} x {:.1f}", box.size().x, box.size().y);
}

/// Sizes in a configuration are in mm, so users who draw an arena in mm need to know that it is scaled.
void tell_scale(Scenario const& scenario, ArenaOutline const& outline, Arena const& arena) {
    constexpr float kSameSize = 5e-3F;  // less is the rounding of corners
    Vec2 const drawn = bounding_box_of_all(outline.polygons).size();
    Vec2 const size_mm = bounding_box_of_all(arena.polygons).size();
    if (scenario.arena_surface_mm2 && length(size_mm - drawn) > kSameSize * length(drawn)) {
        log().info(
            "arena '{}': outline {} scaled to {} mm to match arena_surface {} mm2 (use 'arena_surface: file' to keep "
            "the file's size)",
            scenario.arena_file, size_text(bounding_box_of_all(outline.polygons)), size_text(arena.bounds),
            *scenario.arena_surface_mm2);
    }
}

/// A file in millimetres sets its own size, which must be within the range allowed in a configuration.
void check_size(Scenario const& scenario, Arena const& arena) {
    Vec2 const size_mm = arena.bounds.size();
    if (!scenario.arena_surface_mm2 && std::max(size_mm.x, size_mm.y) > kMaxLength) {
        throw ConfigError(
            fmt::format("{}: the arena '{}' measures {} mm; the largest supported size is {} mm. "
                        "Specify its area in mm2 instead of 'file'",
                        place_of(scenario, Setting::arena_surface), scenario.arena_file, size_text(arena.bounds),
                        number_text(kMaxLength)));
    }
}

/// Other configurations write a periodic square as an empty file, by its name or with a periodic border.
std::filesystem::path arena_file(Scenario const& scenario) {
    std::filesystem::path file = find_file(scenario, Setting::arena_file, scenario.arena_file);
    bool const may_be_empty = scenario.boundary == BoundaryCondition::periodic || is_periodic_square(file);
    if (may_be_empty && is_empty_arena_file(file)) {
        log().info("arena '{}' is empty: it stands for a square without walls, whose sides are joined (periodic)",
                   scenario.arena_file);
        return bundled_periodic_square();
    }
    return file;
}

void build_arena(Scenario const& scenario, World& world) {
    if (scenario.arena_file.empty()) {
        throw ConfigError(
            fmt::format("{}: the key 'arena_file' is missing; specify an outline, such as arenas/disk.csv",
                        line_of(scenario, Setting::arena_file)));
    }
    ArenaOutline const outline = read_arena_file(arena_file(scenario));
    world.periodic = scenario.boundary == BoundaryCondition::periodic || outline.periodic;
    bool const asks_for_walls =
        scenario.boundary == BoundaryCondition::solid && is_written(scenario, Setting::boundary_condition);
    if (outline.periodic && asks_for_walls) {
        log().warn("{}: ignored, because '{}' declares itself periodic; for walls, use another arena_file",
                   place_of(scenario, Setting::boundary_condition), scenario.arena_file);
    }
    world.arena = scale_arena(outline, {.surface_mm2 = scenario.arena_surface_mm2, .stretch = scenario.arena_stretch});
    check_size(scenario, world.arena);
    tell_scale(scenario, outline, world.arena);
}

std::uint32_t add_body(Bodies& bodies, MembraneBody const& body, BodySpec const& spec) {
    auto const index = static_cast<std::uint32_t>(bodies.size());
    bodies.position_mm.push_back(body.position_mm);
    bodies.heading_rad.push_back(wrap_angle(body.heading_rad));
    bodies.heading_dir.push_back(direction(body.heading_rad));
    bodies.velocity_mm_s.push_back({});
    bodies.angular_velocity_rad_s.push_back(0.0F);
    bodies.start_mm.push_back(body.position_mm);
    bodies.start_rad.push_back(bodies.heading_rad.back());
    bodies.radius_mm.push_back(bounding_radius(body.shape));
    bodies.shape.push_back(body.shape);
    bodies.spec.push_back(spec);
    return index;
}

void add_bodies(World& world, Object& object, ObjectSpec const& spec, Placement const& placement) {
    if (!spec.membrane) {
        object.body = add_body(world.bodies, {placement.position_mm, placement.heading_rad, spec.shape}, *spec.body);
        object.body_count = 1;
        return;
    }
    MembraneParts const membrane = make_membrane(spec, placement);
    object.body = static_cast<std::uint32_t>(world.bodies.size());
    object.body_count = static_cast<std::uint32_t>(membrane.bodies.size());
    for (MembraneBody const& body : membrane.bodies) {
        add_body(world.bodies, body, *spec.body);
    }
    world.membranes.push_back({.body = object.body, .body_count = object.body_count});
    for (Joint joint : membrane.joints) {
        joint.a += object.body;
        joint.b += object.body;
        world.joints.push_back(joint);
    }
}

void add_robot(World& world, Object const& object, std::uint32_t seed) {
    Robots& robots = world.robots;
    std::size_t const index = robots.size();
    robots.id.push_back(object.id);
    robots.category.push_back(object.category);
    robots.body.push_back(object.body);
    robots.led.push_back({});
    robots.command.push_back({});
    robots.stream.emplace_back(seed, index);
}

/// The outline along which a wall or a membrane sends.
Outline outline_of(World const& world, Object const& object, ObjectSpec const& spec, Placement const& placement) {
    Outline line{.robot = object.robot, .polygons = {}, .body = object.body, .body_count = object.body_count};
    if (spec.shape.kind == ShapeKind::arena) {
        line.polygons = world.arena.polygons;
    } else if (!spec.membrane) {
        for (Polygon const& part : outlines(spec.shape)) {
            line.polygons.push_back(moved(part, placement.position_mm, placement.heading_rad));
        }
    }
    return line;
}

/// Creates objects one by one and numbers them: those with a rigid body and a program from 0 up, all others from 65535
/// down; of more than 65536 objects from the number of the last one down, so that no two have the same id.
class ObjectMaker {
public:
    ObjectMaker(World& world, std::uint32_t object_count, std::uint32_t seed)
        : world_(world), seed_(seed), next_down_(std::max(object_count, kIdsOnAir) - 1) {}

    void add(std::uint32_t category, Placement const& placement) {
        ObjectSpec const& spec = world_.categories[category].spec;
        bool const is_robot_like = spec.robot && spec.body && !spec.membrane;
        Object object{.id = is_robot_like ? next_up_++ : next_down_--, .category = category};
        if (spec.body) {
            add_bodies(world_, object, spec, placement);
        } else {
            object.fixed_mm =
                spec.shape.kind == ShapeKind::arena ? world_.arena.bounds.centre() : placement.position_mm;
        }
        if (spec.robot) {
            object.robot = static_cast<std::uint32_t>(world_.robots.size());
            add_robot(world_, object, seed_);
            if (spec.robot->model.sends_along_outline) {
                world_.outlines.push_back(outline_of(world_, object, spec, placement));
            }
        }
        world_.objects.push_back(object);
    }

private:
    World& world_;
    std::uint32_t seed_;
    std::uint32_t next_up_ = 0;
    std::uint32_t next_down_;
};

void warn_of_walls(ObjectConfig const& object) {
    if (object.spec.robot) {
        log().warn("objects.{}: a periodic arena has no walls, so no {} is created", object.category, object.type);
    }
}

void add_objects(Scenario const& scenario, World& world, std::uint32_t seed) {
    std::vector<std::vector<Placement>> const poses = place_objects(scenario, world, seed);
    std::vector<std::size_t> created;  // indices into scenario.objects
    std::size_t object_count = 0;
    for (std::size_t i = 0; i < scenario.objects.size(); ++i) {
        if (is_created(scenario.objects[i], world.periodic)) {
            created.push_back(i);
            object_count += poses[i].size();
        } else {
            warn_of_walls(scenario.objects[i]);
        }
    }
    ObjectMaker maker(world, static_cast<std::uint32_t>(object_count), seed);
    for (std::size_t const i : created) {
        ObjectConfig const& object = scenario.objects[i];
        auto const category = static_cast<std::uint32_t>(world.categories.size());
        world.categories.push_back({.name = object.category, .spec = object.spec});
        for (Placement const& placement : poses[i]) {
            maker.add(category, placement);
        }
    }
    warn_of_imported(scenario, world, poses);
}

void warn_of_repeated_ids(World const& world) {
    if (world.robots.size() > kIdsOnAir) {
        log().warn(
            "{} objects run the program, but pogobot_helper_getid() and messages have only {} ids, as on the robot: "
            "ids repeat (robot_id in the data file does not)",
            world.robots.size(), kIdsOnAir);
    }
}

std::string objects_text(Scenario const& scenario) {
    std::int64_t all = 0;
    for (ObjectConfig const& object : scenario.objects) {
        all += object.nb;
    }
    return fmt::format("the objects and their initial positions: {} of them", all);
}

/// A membrane contains whatever is larger than the gaps between its bodies.
void warn_of_gaps(Scenario const& scenario) {
    for (ObjectConfig const& membrane : scenario.objects) {
        if (!membrane.spec.membrane || membrane.nb == 0) {
            continue;
        }
        float const gap_mm = widest_gap_mm(make_membrane(membrane.spec, {}));
        for (ObjectConfig const& other : scenario.objects) {
            if (other.nb > 0 && other.spec.body && !other.spec.membrane &&
                2.0F * bounding_radius(other.spec.shape) < gap_mm) {
                log().warn(
                    "{}: the gaps between its dots can grow to {:.1f} mm, so '{}' may slip through; use more or larger "
                    "dots",
                    place_of(scenario, membrane, ObjectSetting::body_count), gap_mm, other.category);
            }
        }
    }
}

void make_mailboxes(World& world) {
    std::vector<int> sizes;
    for (std::size_t i = 0; i < world.robots.size(); ++i) {
        sizes.push_back(world.spec_of(i).ir.queue_size);
    }
    double messages = 0.0;
    for (int const size : sizes) {
        messages += size;
    }
    constexpr std::size_t message_bytes = sizeof(FrameHeader) + MAX_PAYLOAD_SIZE_BYTES;
    auto const purpose = [&] {
        return fmt::format("the message queues (message_queue_size) of {}: {:.0f} messages of {} bytes",
                           counted(sizes.size(), "robot"), messages, message_bytes);
    };
    allocate_for(purpose, messages * message_bytes,
                 [&] { world.mailboxes = Mailboxes(sizes, MAX_PAYLOAD_SIZE_BYTES); });
}

/// Bodies that a file puts at the same place would stay on top of each other: nothing says where to push them.
void part_bodies(Bodies& bodies) {
    std::vector<std::uint32_t> by_place(bodies.size());
    std::iota(by_place.begin(), by_place.end(), 0U);
    auto const place = [&](std::uint32_t body) {
        return std::pair(bodies.position_mm[body].x, bodies.position_mm[body].y);
    };
    std::ranges::sort(by_place, {}, place);
    std::vector<std::uint32_t> to_move;
    for (auto same = by_place.begin(); same != by_place.end();) {
        auto const next =
            std::ranges::find_if(same, by_place.end(), [&](std::uint32_t i) { return place(i) != place(*same); });
        if (next - same > 1) {
            std::copy_if(same, next, std::back_inserter(to_move),
                         [&](std::uint32_t i) { return !bodies.spec[i].fixed; });
        }
        same = next;
    }
    std::ranges::sort(to_move);
    part_coinciding_centres(bodies.position_mm, to_move);
    bodies.start_mm = bodies.position_mm;
}

World built_world(Scenario const& scenario, std::uint32_t seed) {
    World world;
    world.time_step_s = scenario.time_step_s;
    world.ignore_occlusions = scenario.ignore_occlusions;
    world.walls_block_infrared = scenario.walls.block_infrared;
    world.walls_block_light = scenario.walls.block_light;
    world.original_wall_copies = scenario.wall_copies == WallCopies::original;
    world.temperature_c = static_cast<float>(scenario.arena_temperature_c);
    world.magnetometer = magnetometers_of(scenario, seed);
    build_arena(scenario, world);
    warn_of_gaps(scenario);
    allocate_for([&] { return objects_text(scenario); }, std::nullopt, [&] { add_objects(scenario, world, seed); });
    part_bodies(world.bodies);
    allocate_for([] { return std::string("the links between objects"); }, std::nullopt,
                 [&] { make_links(scenario, world); });
    warn_of_repeated_ids(world);
    make_mailboxes(world);
    auto const devices = [&] { return fmt::format("the devices of {}", counted(world.robots.size(), "robot")); };
    allocate_for(devices, std::nullopt, [&] { set_up_devices(world, seed); });
    world.light = make_light_map(world.arena, world.periodic, scenario.light_map_columns, scenario.light_map_rows);
    assert_structure(world);
    return world;
}

}  // namespace

bool is_created(ObjectConfig const& object, bool is_periodic) {
    bool const is_wall = object.spec.robot && !object.spec.body;
    bool const is_left_out = is_wall && is_periodic && object.nb > 0;
    return (object.spec.robot || object.spec.body) && !is_left_out;
}

void check_arena(Scenario const& scenario) {
    World world;
    build_arena(scenario, world);
}

World build_world(Scenario const& scenario, std::uint32_t seed) {
    try {
        return built_world(scenario, seed);
    } catch (ConfigError const& error) {
        std::string const note = note_on_open_options(scenario);
        if (note.empty()) {
            throw;
        }
        throw ConfigError(error.what() + note);
    }
}

}  // namespace pogosim
