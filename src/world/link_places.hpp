// Where the ends of links are, and what pulls at bodies.
#pragma once

#include <cmath>
#include <vector>

#include "world/world.hpp"

namespace pogosim {

struct LinkPlaces {
    Vec2 a_mm;  // not wrapped
    Vec2 b_mm;  // its image nearest to `a_mm`

    Vec2 span_mm() const { return b_mm - a_mm; }
};

/// The place of a point in a body's own frame.
inline Vec2 place_on_body(Bodies const& bodies, std::uint32_t body, Vec2 point_mm) {
    return bodies.position_mm[body] + rotate(point_mm, bodies.heading_dir[body]);
}

/// An offset in the arena as a body sees it: x ahead, y to its right.
inline Vec2 in_frame_of(Bodies const& bodies, std::uint32_t body, Vec2 offset_mm) {
    Vec2 const ahead = bodies.heading_dir[body];
    return rotate(offset_mm, {ahead.x, -ahead.y});
}

inline LinkPlaces places_of_ends(World const& world, Link const& link) {
    Vec2 const a_mm = place_on_body(world.bodies, link.a, link.end_a_mm);
    Vec2 const b_mm = link.b == kNone ? link.end_b_mm : place_on_body(world.bodies, link.b, link.end_b_mm);
    return {a_mm, a_mm + minimum_image(world, a_mm, b_mm)};
}

/// For each body, the tension of its link with the largest one, whether that pulls (positive) or pushes, N; 0 without
/// links.
inline std::vector<float> tensions_of_bodies(World const& world) {
    std::vector<float> tension_n(world.bodies.size(), 0.0F);
    for (Link const& link : world.links) {
        for (std::uint32_t const body : {link.a, link.b}) {
            if (!link.is_cut && body != kNone && std::abs(link.tension_n) > std::abs(tension_n[body])) {
                tension_n[body] = link.tension_n;
            }
        }
    }
    return tension_n;
}

}  // namespace pogosim
