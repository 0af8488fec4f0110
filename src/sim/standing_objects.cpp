#include "sim/standing_objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/log.hpp"
#include "config/find_file.hpp"
#include "config/places.hpp"
#include "sim/make_membrane.hpp"

namespace pogosim {

std::vector<Obstacle> obstacles_of(ObjectConfig const& object, Placement const& pose) {
    std::string const name = fmt::format("'{}'", object.category);
    if (!object.spec.membrane) {
        return solid_obstacles(name, object.spec.shape, pose.position_mm, pose.heading_rad);
    }
    return {{.name = name,
             .line = membrane_line(object.spec, pose),
             .half_thickness_mm = half_thickness_mm(*object.spec.membrane),
             .solid = false}};
}

void add_standing(ObjectConfig const& object, std::vector<Placement> const& poses,
                  std::vector<StandingObject>& objects) {
    for (Placement const& pose : poses) {
        objects.push_back({&object, pose.position_mm, outer_radius_mm(object.spec), obstacles_of(object, pose)});
    }
}

float half_thickness_mm(ObjectSpec const& spec) {
    return spec.membrane ? half_thickness_mm(*spec.membrane) : inner_radius(spec.shape);
}

OverlapFinder::OverlapFinder(std::vector<StandingObject> const& objects, World const& world)
    : objects_(objects), world_(world) {
    std::vector<Vec2> positions_mm;
    for (StandingObject const& object : objects) {
        positions_mm.push_back(object.position_mm);
        largest_mm_ = std::max(largest_mm_, object.radius_mm);
    }
    grid_.build(positions_mm, world.arena.bounds, std::max(2.0F * largest_mm_, 1.0F), world.periodic);
}

std::vector<Overlap> OverlapFinder::with_earlier(std::size_t object) const {
    StandingObject const& own = objects_[object];
    std::vector<std::size_t> near;
    grid_.for_each_near(own.position_mm, own.radius_mm + largest_mm_, [&](std::uint32_t other, Vec2 place_mm) {
        float const apart_mm = length(minimum_image(world_, own.position_mm, place_mm));
        if (other < object && apart_mm <= own.radius_mm + objects_[other].radius_mm) {
            near.push_back(other);
        }
    });
    std::ranges::sort(near);
    std::vector<Overlap> found;
    for (std::size_t const other : near) {
        if (float const depth = depth_mm(own, objects_[other]); depth > 0.0F) {
            found.push_back({other, depth});
        }
    }
    return found;
}

float OverlapFinder::depth_mm(StandingObject const& one, StandingObject const& other) const {
    float depth = 0.0F;
    for (Obstacle const& a : one.obstacles) {
        for (Obstacle const& b : other.obstacles) {
            depth = std::max(depth, depth_mm(a, b));
        }
    }
    return depth;
}

float OverlapFinder::depth_mm(Obstacle const& one, Obstacle const& other) const {
    float depth = overlap_mm(one, other);
    if (world_.periodic) {
        for (Obstacle const& image : images_across(world_.arena.bounds, other)) {
            depth = std::max(depth, overlap_mm(one, image));
        }
        for (Obstacle const& image : images_across(world_.arena.bounds, one)) {
            depth = std::max(depth, overlap_mm(image, other));
        }
    }
    return depth;
}

float OverlapFinder::into_walls_mm(std::size_t object) const {
    float depth = 0.0F;
    for (Obstacle const& part : objects_[object].obstacles) {
        depth = world_.periodic ? 0.0F : std::max(depth, overlap_mm(part, world_.arena));
    }
    return depth;
}

namespace {

// An overlap is deep if it exceeds this share of half the thickness of the thinner object. Physics resolves the rest.
constexpr float kDeepShare = 0.1F;

/// A problem with the fixed objects of one or two categories; the text names the first object.
struct Finding {
    StandingObject const* entry;
    ObjectConfig const* other;  // nullptr: a wall
    std::string text;
    int more = 0;  // objects or pairs of the same categories
};

std::vector<StandingObject> fixed_objects(Scenario const& scenario) {
    std::vector<StandingObject> objects;
    for (ObjectConfig const& object : scenario.objects) {
        std::vector<Placement> poses = given_poses(object);
        if (object.position_mm && !poses.empty()) {
            poses.resize(1);  // all stand there
        }
        if (object.spec.body) {
            add_standing(object, poses, objects);
        }
    }
    return objects;
}

class Findings {
public:
    void add(StandingObject const& entry, ObjectConfig const* other, std::string const& text) {
        auto const same = std::ranges::find_if(
            all_, [&](Finding const& known) { return known.entry->object == entry.object && known.other == other; });
        if (same == all_.end()) {
            all_.push_back({&entry, other, text});
        } else {
            ++same->more;
        }
    }

    void warn(Scenario const& scenario) const {
        for (auto const& [entry, other, text, more] : all_) {
            log().warn("{}: '{}' at ({:g}, {:g}) {}{}", place_of(scenario, *entry->object, ObjectSetting::x),
                       entry->object->category, entry->position_mm.x, entry->position_mm.y, text,
                       more > 0 ? fmt::format(", and {} more like this", more) : "");
        }
    }

private:
    std::vector<Finding> all_;
};

}  // namespace

void warn_of_overlaps(Scenario const& scenario, World const& world) {
    std::vector<StandingObject> const objects = fixed_objects(scenario);
    Findings findings;
    OverlapFinder const finder(objects, world);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        ObjectConfig const& object = *objects[i].object;
        float const own_mm = half_thickness_mm(object.spec);
        if (object.position_mm && object.nb > 1) {
            findings.add(objects[i], &object, fmt::format("has all {} objects on top of each other", object.nb));
        }
        for (auto const& [k, depth_mm] : finder.with_earlier(i)) {
            StandingObject const& other = objects[k];
            if (depth_mm > kDeepShare * std::min(own_mm, half_thickness_mm(other.object->spec))) {
                findings.add(
                    objects[i], other.object,
                    fmt::format("overlaps {} by {:.1f} mm",
                                other.object == &object ? "another one" : other.obstacles.front().name, depth_mm));
            }
        }
        float const depth_mm = finder.into_walls_mm(i);
        if (depth_mm > kDeepShare * own_mm) {
            findings.add(objects[i], nullptr, fmt::format("extends {:.1f} mm into an arena wall", depth_mm));
        }
    }
    findings.warn(scenario);
}

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
