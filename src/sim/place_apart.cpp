#include "sim/place_apart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "config/places.hpp"
#include "geometry/outline_survey.hpp"
#include "sim/make_membrane.hpp"

namespace pogosim {

namespace {

enum class Overlap { none, partial, full };

/// The part of an area that is in the arena.
Overlap overlap_with(Arena const& arena, Polygon const& area_mm) {
    constexpr std::size_t area = 0;
    constexpr std::size_t outer = 1;
    std::vector<Polygon> polygons{area_mm};
    polygons.insert(polygons.end(), arena.polygons.begin(), arena.polygons.end());
    OutlineSurvey const survey = survey_outlines(polygons);
    if (survey.crossing) {
        return Overlap::partial;
    }
    bool const holds_walls = std::ranges::find(survey.parent, area) != survey.parent.end();
    if (survey.parent[area] == outer) {
        return holds_walls ? Overlap::partial : Overlap::full;
    }
    return survey.parent[outer] == area ? Overlap::partial : Overlap::none;
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

}  // namespace

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
        Overlap const overlap = overlap_with(world.arena, *own.area_mm);
        if (overlap == Overlap::none) {
            throw ConfigError(fmt::format("{}: it lies entirely outside {}", where, arena_text(world.arena)));
        }
        if (overlap == Overlap::partial) {
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

}  // namespace pogosim
