#include "sim/fixed_objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "base/grid.hpp"
#include "base/log.hpp"
#include "config/places.hpp"
#include "sim/make_membrane.hpp"

namespace pogosim {

namespace {

// An overlap is deep if it exceeds this share of half the thickness of the thinner object. Physics resolves the rest.
constexpr float kDeepShare = 0.1F;

struct FixedEntry {
    ObjectConfig const* object;
    Vec2 position_mm;
    float radius_mm;  // of the disk around it
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
    if (spec.membrane) {
        return half_thickness_mm(*spec.membrane);
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
            float const radius_mm = outer_radius_mm(object.spec);
            for (std::size_t i = 0; i < poses.size(); ++i) {
                entries.push_back({&object, poses[i].position_mm, radius_mm, obstacles[i]});
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
            log().warn("{}: '{}' at ({:g}, {:g}) {}{}", place_of(scenario, *entry->object, ObjectSetting::x),
                       entry->object->category, entry->position_mm.x, entry->position_mm.y, text,
                       more > 0 ? fmt::format(", and {} more like this", more) : "");
        }
    }

private:
    std::vector<Finding> all_;
};

/// Finds those that an entry may touch among the ones before it.
class EarlierNeighbours {
public:
    EarlierNeighbours(std::vector<FixedEntry> const& entries, Box bounds_mm) : entries_(entries) {
        std::vector<Vec2> positions_mm;
        for (FixedEntry const& entry : entries) {
            positions_mm.push_back(entry.position_mm);
            largest_mm_ = std::max(largest_mm_, entry.radius_mm);
        }
        grid_.build(positions_mm, bounds_mm, std::max(2.0F * largest_mm_, 1.0F), /*periodic=*/false);
    }

    /// In the order of the entries.
    std::vector<FixedEntry const*> of(std::size_t entry) const {
        FixedEntry const& own = entries_[entry];
        std::vector<FixedEntry const*> found;
        grid_.for_each_near(own.position_mm, own.radius_mm + largest_mm_, [&](std::uint32_t other, Vec2 place_mm) {
            if (other < entry && length(own.position_mm - place_mm) <= own.radius_mm + entries_[other].radius_mm) {
                found.push_back(&entries_[other]);
            }
        });
        std::ranges::sort(found);
        return found;
    }

private:
    std::vector<FixedEntry> const& entries_;
    float largest_mm_ = 0.0F;
    UniformGrid grid_;
};

}  // namespace

std::vector<Obstacle> obstacles_of(ObjectConfig const& object, std::vector<Placement> const& poses) {
    std::vector<Obstacle> obstacles;
    std::string const name = fmt::format("'{}'", object.category);
    for (Placement const& pose : poses) {
        if (object.spec.membrane) {
            obstacles.push_back({.name = name,
                                 .line = membrane_line(object.spec, pose),
                                 .half_thickness_mm = half_thickness_mm(*object.spec.membrane),
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
    EarlierNeighbours const neighbours(entries, world.arena.bounds);
    for (std::size_t i = 0; i < entries.size(); ++i) {
        FixedEntry const* const entry = &entries[i];
        ObjectConfig const& object = *entry->object;
        float const own_mm = half_thickness_mm(object.spec);
        if (object.position_mm && object.nb > 1) {
            findings.add(*entry, &object, fmt::format("has all {} objects on top of each other", object.nb));
        }
        for (FixedEntry const* const other : neighbours.of(i)) {
            float const depth_mm = overlap_mm(entry->obstacle, other->obstacle);
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
