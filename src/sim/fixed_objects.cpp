#include "sim/fixed_objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "base/log.hpp"
#include "sim/make_ring.hpp"

namespace pogosim {

namespace {

// An overlap is deep if it exceeds this share of half the thickness of the thinner object. Physics resolves the rest.
constexpr float kDeepShare = 0.1F;

struct FixedEntry {
    ObjectConfig const* object;
    Vec2 position_mm;
    Obstacle obstacle;
};

/// A problem with the fixed objects of one or two categories; the text is about the first object.
struct Finding {
    FixedEntry const* entry;
    ObjectConfig const* other;  // nullptr: a wall
    std::string text;
    int more = 0;  // objects or pairs of the same categories
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
        std::vector<Placement> poses = given_poses(object);
        if (object.position_mm && !poses.empty()) {
            poses.resize(1);  // all stand there
        }
        if (object.spec.body) {
            std::vector<Obstacle> const obstacles = obstacles_of(object, poses);
            for (std::size_t i = 0; i < poses.size(); ++i) {
                entries.push_back({&object, poses[i].position_mm, obstacles[i]});
            }
        }
    }
    return entries;
}

class Findings {
public:
    void add(FixedEntry const& entry, ObjectConfig const* other, std::string const& text) {
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
            log().warn("{}: '{}' at ({:g}, {:g}) {}{}",
                       where_in_object(scenario, *entry->object, entry->object->position_mm ? "x" : "poses"),
                       entry->object->category, entry->position_mm.x, entry->position_mm.y, text,
                       more > 0 ? fmt::format(", and {} more like this", more) : "");
        }
    }

private:
    std::vector<Finding> all_;
};

bool may_touch(FixedEntry const& a, FixedEntry const& b) {
    return length(a.position_mm - b.position_mm) <= outer_radius_mm(a.object->spec) + outer_radius_mm(b.object->spec);
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
    Findings findings;
    for (auto entry = entries.begin(); entry != entries.end(); ++entry) {
        ObjectConfig const& object = *entry->object;
        float const own_mm = half_thickness_mm(object.spec);
        if (object.position_mm && object.nb > 1) {
            findings.add(*entry, &object, fmt::format("has all {} objects on top of each other", object.nb));
        }
        for (auto other = entries.begin(); other != entry; ++other) {
            float const depth_mm = may_touch(*entry, *other) ? overlap_mm(entry->obstacle, other->obstacle) : 0.0F;
            if (depth_mm > kDeepShare * std::min(own_mm, half_thickness_mm(other->object->spec))) {
                findings.add(*entry, other->object,
                             fmt::format("overlaps {} by {:.1f} mm",
                                         other->object == &object ? "another one" : other->obstacle.name, depth_mm));
            }
        }
        float const depth_mm = world.periodic ? 0.0F : overlap_mm(entry->obstacle, world.arena);
        if (depth_mm > kDeepShare * own_mm) {
            findings.add(*entry, nullptr, fmt::format("extends {:.1f} mm into an arena wall", depth_mm));
        }
    }
    findings.warn(scenario);
}

}  // namespace pogosim
