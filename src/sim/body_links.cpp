#include "sim/body_links.hpp"

#include <algorithm>
#include <cmath>

#include "world/link_places.hpp"

namespace pogosim {

namespace {

constexpr float kLeastTensionN = 1e-6F;  // that is shown: rounding is not

/// The largest tension of all links that do not break.
float largest_tension_n(std::vector<Link> const& links) {
    float largest_n = 0.0F;
    for (Link const& link : links) {
        if (!link.is_cut && !std::isfinite(link.breaking_n)) {
            largest_n = std::max(largest_n, std::abs(link.tension_n));
        }
    }
    return largest_n;
}

}  // namespace

std::vector<BodyLink> drawn_links(World const& world) {
    std::vector<BodyLink> drawn;
    float const largest_n = std::max(largest_tension_n(world.links), kLeastTensionN);
    for (Link const& link : world.links) {
        if (link.is_cut || !world.link_categories[link.link_category].are_drawn) {
            continue;
        }
        LinkPlaces const ends = places_of_ends(world, link);
        Vec2 const from_mm = wrapped(world, ends.a_mm);
        drawn.push_back({.kind = link.kind,
                         .is_pinned = link.b == kNone,
                         .from_mm = from_mm,
                         .to_mm = from_mm + ends.span_mm(),
                         .load = link.tension_n / (std::isfinite(link.breaking_n) ? link.breaking_n : largest_n)});
    }
    return drawn;
}

}  // namespace pogosim
