#include "sim/imported_objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include "base/log.hpp"
#include "config/find_file.hpp"
#include "config/places.hpp"
#include "sim/standing_objects.hpp"

namespace pogosim {

namespace {

// Smaller overlaps may come from the run that wrote the file: physics lets bodies overlap a little for a moment. For
// small bodies, the limit is a share of half their thickness.
constexpr float kToleratedMm = 1.0F;
constexpr float kToleratedShare = 0.1F;

float tolerated_mm(StandingObject const& object) {
    return std::min(kToleratedMm, kToleratedShare * half_thickness_mm(object.object->spec));
}

/// All bodies, and which of them are imported.
struct Standing {
    std::vector<StandingObject> objects;
    std::vector<std::uint32_t> id;
    std::vector<bool> imported;

    std::string name(std::size_t i) const { return fmt::format("{} {}", objects[i].object->category, id[i]); }
};

/// The objects of the world are in the order of the entries; those without a body and absent ones are left out.
Standing standing_objects(Scenario const& scenario, World const& world,
                          std::vector<std::vector<Placement>> const& poses) {
    std::vector<std::uint32_t> ids;
    for (Object const& object : world.objects) {
        if (object.body != kNone) {
            ids.push_back(object.id);
        }
    }
    Standing standing;
    standing.id = std::move(ids);
    for (std::size_t i = 0; i < scenario.objects.size(); ++i) {
        ObjectConfig const& object = scenario.objects[i];
        if (object.spec.body) {
            add_standing(object, poses[i], standing.objects);
            standing.imported.resize(standing.objects.size(), is_imported(scenario, object));
        }
    }
    return standing;
}

void warn_of_overlapping(std::string const& file, Standing const& standing, OverlapFinder const& finder) {
    std::size_t pairs = 0;
    std::string first;
    std::vector<bool> overlaps(standing.objects.size());
    for (std::size_t i = 0; i < standing.objects.size(); ++i) {
        StandingObject const& own = standing.objects[i];
        for (auto const& [k, depth_mm] : finder.with_earlier(i)) {
            StandingObject const& other = standing.objects[k];
            bool const is_deep = depth_mm > std::min(tolerated_mm(own), tolerated_mm(other));
            if (!is_deep || !(standing.imported[i] || standing.imported[k])) {
                continue;
            }
            overlaps[i] = overlaps[k] = true;
            if (pairs++ == 0) {
                first = fmt::format("{} at ({:.4g}, {:.4g}) and {} at ({:.4g}, {:.4g}) mm by {:.1f} mm",
                                    standing.name(k), other.position_mm.x, other.position_mm.y, standing.name(i),
                                    own.position_mm.x, own.position_mm.y, depth_mm);
            }
        }
    }
    if (pairs > 0) {
        bool const all = std::ranges::all_of(overlaps, [](bool does) { return does; });
        log().warn("{}: {} overlap: {}{}; physics pushes them apart{}", file,
                   pairs == 1 ? "two objects" : fmt::format("{} pairs of objects", pairs), pairs == 1 ? "" : "first ",
                   first,
                   all ? ". All objects do: if the file is not in mm, imported_formation_min_coords and "
                         "imported_formation_max_coords say which of its coordinates are the arena's corners"
                       : "");
    }
}

void warn_of_walls(std::string const& file, Standing const& standing, OverlapFinder const& finder) {
    std::size_t count = 0;
    std::string first;
    for (std::size_t i = 0; i < standing.objects.size(); ++i) {
        StandingObject const& own = standing.objects[i];
        float const depth_mm = standing.imported[i] ? finder.into_walls_mm(i) : 0.0F;
        if (depth_mm > tolerated_mm(own) && count++ == 0) {
            first = fmt::format("{} at ({:.4g}, {:.4g}) mm by {:.1f} mm", standing.name(i), own.position_mm.x,
                                own.position_mm.y, depth_mm);
        }
    }
    if (count > 0) {
        log().warn("{}: {} into a wall: {}{}; physics pushes {} out", file,
                   count == 1 ? "an object reaches" : fmt::format("{} objects reach", count),
                   count == 1 ? "" : "first ", first, count == 1 ? "it" : "them");
    }
}

}  // namespace

bool is_imported(Scenario const& scenario, ObjectConfig const& object) {
    return scenario.formation.name == kImportedFormation && object.spec.body && !object.position_mm &&
           object.poses.empty() && !object.own_formation.is_given();
}

void warn_of_imported(Scenario const& scenario, World const& world, std::vector<std::vector<Placement>> const& poses) {
    if (scenario.formation.name != kImportedFormation) {
        return;
    }
    Standing const standing = standing_objects(scenario, world, poses);
    OverlapFinder const finder(standing.objects, world);
    std::string const file = find_file(scenario, Setting::formation_filename, scenario.formation.filename).string();
    warn_of_overlapping(file, standing, finder);
    warn_of_walls(file, standing, finder);
}

}  // namespace pogosim
