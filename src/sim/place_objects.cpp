#include "sim/place_objects.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/random.hpp"
#include "config/find_file.hpp"
#include "config/places.hpp"
#include "config/scenario.hpp"
#include "geometry/outline_survey.hpp"
#include "record/imported_poses.hpp"
#include "sim/lamps_of.hpp"
#include "sim/make_membrane.hpp"
#include "sim/standing_objects.hpp"
#include "world/world.hpp"

namespace pogosim {

namespace {

// Categories with their own area or formation.

enum class AreaOverlap { none, partial, full };

/// The part of an area that is in the arena.
AreaOverlap overlap_with(Arena const& arena, Polygon const& area_mm) {
    constexpr std::size_t area = 0;
    constexpr std::size_t outer = 1;
    std::vector<Polygon> polygons{area_mm};
    polygons.insert(polygons.end(), arena.polygons.begin(), arena.polygons.end());
    OutlineSurvey const survey = survey_outlines(polygons);
    if (survey.crossing) {
        return AreaOverlap::partial;
    }
    bool const holds_walls = std::ranges::find(survey.parent, area) != survey.parent.end();
    if (survey.parent[area] == outer) {
        return holds_walls ? AreaOverlap::partial : AreaOverlap::full;
    }
    return survey.parent[outer] == area ? AreaOverlap::partial : AreaOverlap::none;
}

/// Everything outside the arena, as obstacles.
std::vector<Obstacle> outside_of(Arena const& arena) {
    // A frame around the arena, cut open along a line from its corner to the corner of the outer wall next to it.
    Polygon frame = arena.outer();
    if (signed_area(frame) < 0.0) {
        std::ranges::reverse(frame);
    }
    auto const first = std::ranges::min_element(frame, {}, [](Vec2 corner) { return corner.x + corner.y; });
    std::rotate(frame.begin(), first, frame.end());
    frame.push_back(frame.front());
    Vec2 const size = arena.bounds.size();
    Vec2 const low = arena.bounds.min - size;
    Vec2 const high = arena.bounds.max + size;
    frame.insert(frame.end(), {low, {low.x, high.y}, high, {high.x, low.y}, low});
    std::vector<Obstacle> obstacles{{.name = "the arena's wall", .line = std::move(frame)}};
    for (auto hole = arena.polygons.begin() + 1; hole != arena.polygons.end(); ++hole) {
        obstacles.push_back({.name = "a hole in the arena", .line = *hole});
    }
    return obstacles;
}

/// Places the objects of an entry that has an `own_formation`: inside the part of its area that is in the arena, clear
/// of the obstacles. One pose per object. Throws ConfigError if they do not fit, or if the area is outside the arena.
std::vector<Placement> place_apart(Scenario const& scenario, World const& world, ObjectConfig const& object,
                                   std::vector<Obstacle> obstacles, RandomStream& random) {
    OwnFormation const& own = object.own_formation;
    FormationSpec formation = scenario.formation;
    formation.name = own.name.value_or(formation.name);
    std::string const where = place_of(scenario, object, ObjectSetting::formation);
    if (formation.name == kImportedFormation) {
        throw ConfigError(fmt::format(
            "{}: the formation 'imported' cannot fill an area; give the category its own initial_formation, or "
            "poses",
            where));
    }
    std::vector<float> const radii(static_cast<std::size_t>(object.nb), outer_radius_mm(object.spec));
    Arena const ground = own.area_mm ? make_arena({*own.area_mm}) : world.arena;
    if (own.area_mm) {
        AreaOverlap const overlap = overlap_with(world.arena, *own.area_mm);
        if (overlap == AreaOverlap::none) {
            throw ConfigError(fmt::format("{}: it lies entirely outside {}", where, arena_text(world.arena)));
        }
        if (overlap == AreaOverlap::partial) {
            std::ranges::move(outside_of(world.arena), std::back_inserter(obstacles));
        }
        formation.centre_mm = centroid(*own.area_mm);
    }
    try {
        return own.area_mm ? place(formation, radii, {ground, obstacles, "area", "enlarge the area"}, random)
                           : place(formation, radii, {ground, obstacles}, random);
    } catch (FormationError const& error) {
        throw ConfigError(fmt::format("{}: {}", where, error.what()));
    }
}

// The random stream of the formation belongs to no robot; robots have theirs by their index.
constexpr std::uint64_t kFormationStream = std::uint64_t{3} << 32U;

// A smaller distance between bodies of a membrane is below the tolerance of the physics.
constexpr float kSmallestStepMm = 0.1F;

constexpr std::size_t kNoEntry = std::numeric_limits<std::size_t>::max();

bool is_placed_by_formation(ObjectConfig const& object) {
    return object.spec.body && !object.position_mm && object.poses.empty();
}

bool stands_inside(World const& world, Vec2 point_mm) {
    return world.arena.bounds.contains(point_mm) && (world.periodic || world.arena.contains(point_mm));
}

[[noreturn]] void fail_too_large(Scenario const& scenario, World const& world, ObjectConfig const& object,
                                 float size_mm) {
    throw ConfigError(fmt::format("{}: the object is {:.1f} mm across, too large for {}",
                                  place_of(scenario, object, ObjectSetting::size), size_mm, arena_text(world.arena)));
}

/// A formation needs room for a disk around each object; report this at the object, not when the formation fails.
void check_size(Scenario const& scenario, World const& world, ObjectConfig const& object) {
    float const needed_mm = 2.0F * outer_radius_mm(object.spec);
    Vec2 const room_mm = world.arena.bounds.size();
    if (object.nb > 0 && needed_mm > std::min(room_mm.x, room_mm.y)) {
        fail_too_large(scenario, world, object, needed_mm);
    }
}

/// Bodies of a membrane need a line to lie on and some distance from each other.
void check_membrane(Scenario const& scenario, ObjectConfig const& object) {
    MembraneSpec const& membrane = *object.spec.membrane;
    float const radius_mm = bounding_radius(object.spec.shape);
    if (half_thickness_mm(membrane) > radius_mm) {
        throw ConfigError(fmt::format("{}: the membrane is too thick for a shape of radius {:g} mm",
                                      place_of(scenario, object, ObjectSetting::membrane_thickness), radius_mm));
    }
    Polygon const line = membrane_line(object.spec, {});
    float const step_mm = length(line[1] - line[0]);
    if (step_mm < kSmallestStepMm) {
        throw ConfigError(fmt::format("{}: that many would be only {:.2g} mm apart; the minimum is {} mm",
                                      place_of(scenario, object, ObjectSetting::body_count), step_mm, kSmallestStepMm));
    }
}

[[noreturn]] void fail_outside(Scenario const& scenario, World const& world, ObjectConfig const& object,
                               Vec2 centre_mm) {
    auto const [x, y] = centre_mm;
    Box const& box = world.arena.bounds;
    bool const x_fits = x >= box.min.x && x <= box.max.x;
    bool const y_fits = y >= box.min.y && y <= box.max.y;
    ObjectSetting const setting = x_fits && !y_fits ? ObjectSetting::y : ObjectSetting::x;
    throw ConfigError(fmt::format("{}: ({:g}, {:g}) is {} {}", place_of(scenario, object, setting), x, y,
                                  x_fits && y_fits ? "beyond the walls of" : "outside", arena_text(world.arena)));
}

void check_position(Scenario const& scenario, World const& world, ObjectConfig const& object, Placement const& pose) {
    Vec2 const centre_mm = pose.position_mm;
    if (!stands_inside(world, centre_mm)) {
        fail_outside(scenario, world, object, centre_mm);
    }
    if (!is_everywhere(object.spec.shape)) {
        Vec2 const size_mm = bounding_box(object.spec.shape).size();
        Vec2 const room_mm = world.arena.bounds.size();
        if (size_mm.x > room_mm.x || size_mm.y > room_mm.y) {
            fail_too_large(scenario, world, object, std::max(size_mm.x, size_mm.y));
        }
    }
    if (!object.spec.membrane) {
        return;
    }
    auto const is_inside = [&](Vec2 point) { return stands_inside(world, point); };
    std::string const where = place_of(scenario, object, ObjectSetting::size);
    if (!std::ranges::all_of(moved(outline(object.spec.shape), centre_mm, pose.heading_rad), is_inside)) {
        throw ConfigError(fmt::format("{}: around ({:g}, {:g}) the object reaches beyond {}", where, centre_mm.x,
                                      centre_mm.y, arena_text(world.arena)));
    }
    if (!std::ranges::all_of(make_membrane(object.spec, pose).bodies, is_inside, &MembraneBody::position_mm)) {
        throw ConfigError(
            fmt::format("{}: around ({:g}, {:g}) some dots of the object would start beyond the walls of {}", where,
                        centre_mm.x, centre_mm.y, arena_text(world.arena)));
    }
}

/// The entry that bounds the formation; kNoEntry: the arena.
std::size_t root_entry(Scenario const& scenario) {
    std::string const& root = scenario.formation.root_object;
    auto const found = std::ranges::find(scenario.objects, root, &ObjectConfig::category);
    bool const is_arena = root.empty() || root == "arena" || root == "null" || found == scenario.objects.end();
    return is_arena ? kNoEntry : static_cast<std::size_t>(found - scenario.objects.begin());
}

/// Appended to a message that gives only the number of objects: ". Radii: robots (40) 26.5 mm, ..."; empty if there is
/// only one category.
std::string radii_text(Scenario const& scenario, std::vector<std::size_t> const& entries) {
    std::vector<std::string> radii;
    for (std::size_t const i : entries) {
        ObjectConfig const& object = scenario.objects[i];
        if (object.nb > 0) {
            radii.push_back(fmt::format("{} ({}) {:.4g} mm", object.category, object.nb, outer_radius_mm(object.spec)));
        }
    }
    return radii.size() > 1 ? fmt::format(". Radii: {}", fmt::join(radii, ", ")) : "";
}

/// The space that the first object of the root category encloses.
Arena root_domain(Scenario const& scenario, World const& world, ObjectConfig const& root,
                  std::vector<Placement> const& poses) {
    ObjectSpec const& spec = root.spec;
    bool const is_solid = spec.body && !spec.membrane;
    if (root.nb == 0 || is_solid) {
        throw ConfigError(fmt::format("{}: '{}' {}; use the arena, a wall, a membrane or a lamp",
                                      place_of(scenario, Setting::formation_root), root.category,
                                      is_solid ? "is solid, so nothing fits inside" : "has no objects"));
    }
    if (spec.lamp) {
        auto const [shape, centre_mm] = area_at_start(*spec.lamp);
        return is_everywhere(shape) ? world.arena : make_arena({moved(outline(shape), centre_mm, 0.0F)});
    }
    if (spec.shape.kind == ShapeKind::arena) {
        return world.arena;
    }
    Polygon space = outline(inset(spec.shape, spec.membrane ? 2.0F * half_thickness_mm(*spec.membrane) : 0.0F));
    if (signed_area(space) < 1.0) {
        throw ConfigError(fmt::format("{}: the membrane of '{}' is so thick that it leaves no space inside; enlarge {}",
                                      place_of(scenario, Setting::formation_root), root.category,
                                      place_of(scenario, root, ObjectSetting::size)));
    }
    Placement const& pose = poses.front();
    return make_arena({moved(space, pose.position_mm, pose.heading_rad)});
}

/// The area of a lamp may reach beyond the arena, but no object starts beyond the walls.
void check_inside(Scenario const& scenario, World const& world, ObjectConfig const& root,
                  std::vector<std::vector<Placement>> const& poses) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
        bool const is_placed = is_placed_by_formation(scenario.objects[i]);
        for (Placement const& pose : poses[i]) {
            if (is_placed && !stands_inside(world, pose.position_mm)) {
                throw ConfigError(
                    fmt::format("{}: '{}' reaches beyond {}, and some of its contents would start there; "
                                "move it or make it smaller",
                                place_of(scenario, Setting::formation_root), root.category, arena_text(world.arena)));
            }
        }
    }
}

std::size_t count_objects(Scenario const& scenario, std::vector<std::size_t> const& entries) {
    std::size_t count = 0;
    for (std::size_t const i : entries) {
        count += static_cast<std::size_t>(scenario.objects[i].nb);
    }
    return count;
}

/// Lets the formation place the objects of these entries together.
void place_entries(Scenario const& scenario, FormationSpec const& formation, FormationGround const& ground,
                   std::vector<std::size_t> const& entries, RandomStream& random,
                   std::vector<std::vector<Placement>>& poses) {
    std::vector<float> radii;
    for (std::size_t const i : entries) {
        ObjectConfig const& object = scenario.objects[i];
        radii.insert(radii.end(), static_cast<std::size_t>(object.nb), outer_radius_mm(object.spec));
    }
    std::vector<Placement> placed;
    try {
        placed = place(formation, radii, ground, random, read_imported_feather);
    } catch (FormationError const& error) {
        throw ConfigError(fmt::format("{}: {}{}", line_of(scenario, error), error.what(),
                                      error.key() == kFormationKey ? radii_text(scenario, entries) : ""));
    }
    auto next = placed.begin();
    for (std::size_t const i : entries) {
        auto const end = next + scenario.objects[i].nb;
        poses[i].assign(next, end);
        next = end;
    }
}

}  // namespace

float lattice_spacing_mm(Scenario const& scenario, ObjectConfig const& object) {
    std::vector<float> radii{outer_radius_mm(object.spec)};
    std::size_t const root = root_entry(scenario);
    for (std::size_t i = 0; i < scenario.objects.size() && !object.own_formation.is_given(); ++i) {
        ObjectConfig const& other = scenario.objects[i];
        if (i != root && is_placed_by_formation(other) && !other.own_formation.is_given() && other.nb > 0) {
            radii.push_back(outer_radius_mm(other.spec));
        }
    }
    return lattice_spacing_of(scenario.formation, radii);
}

std::vector<std::vector<Placement>> place_objects(Scenario const& scenario, World const& world, std::uint32_t seed) {
    std::vector<std::vector<Placement>> poses(scenario.objects.size());
    std::vector<std::size_t> entries;      // for the formation
    std::vector<std::size_t> own_entries;  // for their own formations, which come first
    std::vector<Obstacle> obstacles;       // that the formation avoids
    std::size_t const root = root_entry(scenario);
    RandomStream random(seed, kFormationStream);
    FormationSpec formation = scenario.formation;
    if (formation.name == kImportedFormation) {
        formation.filename = find_file(scenario, Setting::formation_filename, formation.filename).string();
    }

    auto const add_obstacles = [&](std::size_t i) {
        for (Placement const& pose : poses[i]) {
            for (Obstacle& obstacle : obstacles_of(scenario.objects[i], pose)) {
                if (world.periodic) {
                    std::ranges::move(images_across(world.arena.bounds, obstacle), std::back_inserter(obstacles));
                }
                obstacles.push_back(std::move(obstacle));
            }
        }
    };
    for (std::size_t i = 0; i < scenario.objects.size(); ++i) {
        ObjectConfig const& object = scenario.objects[i];
        if (object.spec.membrane && object.nb > 0) {
            check_membrane(scenario, object);
        }
        if (is_placed_by_formation(object)) {
            check_size(scenario, world, object);
            (object.own_formation.is_given() ? own_entries : entries).push_back(i);
        } else if (object.spec.body || object.spec.robot) {
            poses[i] = given_poses(object);
            bool const is_absent_wall = !object.spec.body && world.periodic;
            for (Placement const& pose : poses[i]) {
                if (!is_absent_wall) {
                    check_position(scenario, world, object, pose);
                }
            }
            poses[i].resize(static_cast<std::size_t>(object.nb));  // arena walls have no position
            if (object.spec.body) {
                add_obstacles(i);
            }
        }
    }
    if (formation.name == kImportedFormation) {
        for (std::size_t i = 0; i < scenario.objects.size(); ++i) {
            ObjectConfig const& object = scenario.objects[i];
            if (std::ranges::find(entries, i) == entries.end()) {
                formation.placed_apart.push_back(object.category);
            } else {
                formation.categories.push_back({object.category, static_cast<std::size_t>(object.nb)});
            }
        }
    }
    warn_of_overlaps(scenario, world);
    for (std::size_t const i : own_entries) {
        poses[i] = place_apart(scenario, world, scenario.objects[i], obstacles, random);
        add_obstacles(i);
    }
    Arena domain = world.arena;
    if (root != kNoEntry) {
        if (auto const place = std::ranges::find(entries, root); place != entries.end()) {
            // It is placed first, but the rows of an imported file follow the order of the categories.
            std::size_t const rows_before = count_objects(scenario, {entries.begin(), place});
            FormationSpec of_root = formation;
            of_root.rows_of_others = {.first = 0, .count = rows_before, .may_follow = true};
            formation.rows_of_others = {.first = rows_before, .count = count_objects(scenario, {root})};
            entries.erase(place);
            place_entries(scenario, of_root,
                          {.domain = world.arena, .obstacles = obstacles, .periodic = world.periodic}, {root}, random,
                          poses);
            add_obstacles(root);
        }
        domain = root_domain(scenario, world, scenario.objects[root], poses[root]);
    }
    try {
        bool const in_arena = root == kNoEntry;
        place_entries(scenario, formation,
                      {.domain = domain, .obstacles = obstacles, .periodic = in_arena && world.periodic}, entries,
                      random, poses);
    } catch (ConfigError const& error) {
        if (root == kNoEntry) {
            throw;
        }
        throw ConfigError(fmt::format("{} (inside '{}': {})", error.what(), scenario.objects[root].category,
                                      place_of(scenario, Setting::formation_root)));
    }
    if (root != kNoEntry) {
        check_inside(scenario, world, scenario.objects[root], poses);
    }
    return poses;
}

}  // namespace pogosim
