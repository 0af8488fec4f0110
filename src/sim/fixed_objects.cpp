#include "sim/fixed_objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "base/log.hpp"
#include "sim/make_ring.hpp"

namespace pogosim {

namespace {

// Deep is more than this part of half the thickness of the thinner one. Less is soon pushed apart.
constexpr float kDeepShare = 0.1F;

struct FixedEntry {
    ObjectConfig const* object;
    Obstacle obstacle;
};

float half_thickness_mm(ObjectSpec const& spec) {
    if (spec.ring) {
        return half_thickness_mm(*spec.ring);
    }
    switch (spec.shape.kind) {
        case ShapeKind::rectangle:
            return 0.5F * std::min(spec.shape.width_mm, spec.shape.height_mm);
        case ShapeKind::triangle:
            return 0.5F * bounding_radius(spec.shape);
        default:
            return bounding_radius(spec.shape);
    }
}

std::vector<FixedEntry> fixed_entries(Scenario const& scenario) {
    std::vector<FixedEntry> entries;
    for (ObjectConfig const& object : scenario.objects) {
        if (object.spec.body && object.position_mm && object.nb > 0) {
            entries.push_back({&object, obstacles_of(object, {{*object.position_mm, 0.0F}}).front()});
        }
    }
    return entries;
}

void warn(Scenario const& scenario, FixedEntry const& entry, std::string const& text) {
    log().warn("{}: at ({:g}, {:g}) {}", where_in_object(scenario, *entry.object, "x"), entry.object->position_mm->x,
               entry.object->position_mm->y, text);
}

}  // namespace

std::vector<Obstacle> obstacles_of(ObjectConfig const& object, std::vector<Placement> const& poses) {
    std::vector<Obstacle> obstacles;
    std::string const name = fmt::format("'{}'", object.category);
    for (Placement const& pose : poses) {
        if (object.spec.ring) {
            obstacles.push_back({.name = name,
                                 .line = ring_line(object.spec, pose),
                                 .half_thickness_mm = half_thickness_mm(*object.spec.ring),
                                 .solid = false});
        } else {
            obstacles.push_back(solid_obstacle(name, object.spec.shape, pose.position_mm, pose.heading_rad));
        }
    }
    return obstacles;
}

void warn_of_overlaps(Scenario const& scenario, World const& world) {
    std::vector<FixedEntry> const entries = fixed_entries(scenario);
    for (auto entry = entries.begin(); entry != entries.end(); ++entry) {
        float const own_mm = half_thickness_mm(entry->object->spec);
        if (entry->object->nb > 1) {
            warn(scenario, *entry,
                 fmt::format("all {} objects of '{}' stand inside each other", entry->object->nb,
                             entry->object->category));
        }
        for (auto other = entries.begin(); other != entry; ++other) {
            float const depth_mm = overlap_mm(entry->obstacle, other->obstacle);
            if (depth_mm > kDeepShare * std::min(own_mm, half_thickness_mm(other->object->spec))) {
                warn(scenario, *entry,
                     fmt::format("'{}' reaches {:.1f} mm deep into {}", entry->object->category, depth_mm,
                                 other->obstacle.name));
            }
        }
        float const depth_mm = world.periodic ? 0.0F : overlap_mm(entry->obstacle, world.arena);
        if (depth_mm > kDeepShare * own_mm) {
            warn(
                scenario, *entry,
                fmt::format("'{}' reaches {:.1f} mm deep into a wall of the arena", entry->object->category, depth_mm));
        }
    }
}

}  // namespace pogosim
