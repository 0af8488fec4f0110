#include "sim/fixed_objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/log.hpp"
#include "config/places.hpp"
#include "sim/standing_objects.hpp"

namespace pogosim {

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

}  // namespace pogosim
