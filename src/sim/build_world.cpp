#include "sim/build_world.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/error.hpp"
#include "base/log.hpp"
#include "interface/pogobase_inside.hpp"
#include "light/lighting.hpp"
#include "record/imported_poses.hpp"

namespace pogosim {

namespace {

// Random streams of the run that belong to no robot; robots have theirs by their index.
constexpr std::uint64_t kFormationStream = std::uint64_t{3} << 32U;

/// Folders with the arenas that come along: of the installed library, wherever it has been moved to, and of the
/// sources.
std::vector<std::filesystem::path> data_folders() {
    std::vector<std::filesystem::path> folders;
    Dl_info library = {};
    if (dladdr(reinterpret_cast<void const*>(&build_world), &library) != 0 && library.dli_fname != nullptr) {
        std::filesystem::path const folder = std::filesystem::path(library.dli_fname).parent_path();
        folders.push_back(folder / POGOSIM_DATA_FROM_LIBRARY);
    }
    folders.emplace_back(POGOSIM_SOURCE_DATA_DIR);
    return folders;
}

/// A file that the configuration names under `key`: below the working folder, else below the data folders.
std::filesystem::path find_file(Scenario const& scenario, std::string const& key, std::string const& name) {
    std::filesystem::path const path(name);
    std::error_code ignored;
    if (path.empty() || std::filesystem::exists(path, ignored)) {
        return path;
    }
    if (path.is_relative()) {
        for (std::filesystem::path const& folder : data_folders()) {
            if (std::filesystem::exists(folder / path, ignored)) {
                return folder / path;
            }
        }
    }
    Node const* const entry = scenario.resolved.find(key);
    throw ConfigError(fmt::format(
        "{}{}: there is no file '{}'; it is looked for from the working folder ({}), then in the "
        "folder of Pogosim. Arenas that come along: arenas/disk.csv, arenas/square.csv, ...",
        entry != nullptr ? entry->where() + ": " : "", key, name, std::filesystem::current_path(ignored).string()));
}

ArenaOutline unit_square() {
    return {.polygons = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}, .source = "square"};
}

void build_arena(Scenario const& scenario, World& world) {
    ArenaOutline outline = read_arena_file(find_file(scenario, "arena_file", scenario.arena_file));
    world.periodic = scenario.boundary == BoundaryCondition::periodic;
    if (outline.polygons.empty()) {
        log().warn("arena file '{}' is empty: the arena is a square with a periodic boundary", scenario.arena_file);
        outline = unit_square();
        world.periodic = true;
    }
    world.arena = scale_arena(outline, {.surface_mm2 = scenario.arena_surface_mm2, .stretch = scenario.arena_stretch});
}

void add_body(Bodies& bodies, RobotSpec const& spec, Placement const& placement) {
    bodies.position_mm.push_back(placement.position_mm);
    bodies.heading_rad.push_back(placement.heading_rad);
    bodies.axis.push_back(direction(placement.heading_rad));
    bodies.velocity_mm_s.push_back({});
    bodies.spin_rad_s.push_back(0.0F);
    bodies.radius_mm.push_back(bounding_radius(spec.shape));
    bodies.shape.push_back(spec.shape);
    bodies.spec.push_back(spec.body);
}

void add_robot(World& world, std::uint16_t category, Placement const& placement, std::uint32_t seed) {
    Robots& robots = world.robots;
    std::size_t const index = robots.size();
    robots.id.push_back(static_cast<std::uint16_t>(index));
    robots.category.push_back(category);
    robots.body.push_back(static_cast<std::uint32_t>(world.bodies.size()));
    robots.led.push_back({});
    robots.drive.push_back({});
    robots.stream.emplace_back(seed, index);
    add_body(world.bodies, world.categories[category].spec, placement);
}

/// Radii of all objects that the formation places, in the order of the configuration.
std::vector<float> radii_to_place(Scenario const& scenario) {
    std::vector<float> radii;
    for (ObjectConfig const& object : scenario.objects) {
        auto const* const robot = std::get_if<RobotSpec>(&object.spec);
        if (robot != nullptr && !object.position_mm) {
            radii.insert(radii.end(), static_cast<std::size_t>(object.nb), bounding_radius(robot->shape));
        }
    }
    return radii;
}

/// What bounds the formation: the arena, or the contour of the first object of a category.
Arena formation_domain(Scenario const& scenario, World const& world) {
    std::string const& root = scenario.formation.root_object;
    if (root.empty() || root == "arena" || root == "null") {
        return world.arena;
    }
    throw ConfigError(
        fmt::format("initial_formation_root_object: no object with a contour is called '{}'; use 'arena'", root));
}

void place_robots(Scenario const& scenario, World& world, std::uint32_t seed) {
    RandomStream random(seed, kFormationStream);
    std::vector<float> const radii = radii_to_place(scenario);
    FormationSpec formation = scenario.formation;
    formation.filename = find_file(scenario, "formation_filename", formation.filename).string();
    std::vector<Placement> const placements =
        place(formation, radii, formation_domain(scenario, world), random, read_imported_feather);
    auto next = placements.begin();
    for (ObjectConfig const& object : scenario.objects) {
        auto const* const spec = std::get_if<RobotSpec>(&object.spec);
        if (spec == nullptr) {
            continue;
        }
        auto const category = static_cast<std::uint16_t>(world.categories.size());
        world.categories.push_back({.name = object.category, .spec = *spec});
        for (int n = 0; n < object.nb; ++n) {
            add_robot(world, category, object.position_mm ? Placement{*object.position_mm, 0.0F} : *next++, seed);
        }
    }
}

void make_mailboxes(World& world) {
    std::vector<int> sizes;
    for (std::size_t i = 0; i < world.robots.size(); ++i) {
        sizes.push_back(world.spec_of(i).ir.queue_size);
    }
    world.mailboxes = Mailboxes(sizes, MAX_PAYLOAD_SIZE_BYTES);
}

}  // namespace

World build_world(Scenario const& scenario, std::uint32_t seed) {
    World world;
    world.time_step_s = scenario.time_step_s;
    world.ignore_occlusions = scenario.ignore_occlusions;
    world.temperature_c = static_cast<float>(scenario.arena_temperature_c);
    build_arena(scenario, world);
    place_robots(scenario, world, seed);
    make_mailboxes(world);
    world.light = make_light_map(world.arena, scenario.light_map_columns, scenario.light_map_rows);
    return world;
}

std::vector<LampSpec> lamps_of(Scenario const& scenario) {
    std::vector<LampSpec> lamps;
    for (ObjectConfig const& object : scenario.objects) {
        if (auto const* const lamp = std::get_if<LampSpec>(&object.spec)) {
            lamps.insert(lamps.end(), static_cast<std::size_t>(object.nb), *lamp);
        }
    }
    return lamps;
}

}  // namespace pogosim
