#include "render/snapshot.hpp"

#include <cmath>

namespace pogosim {

Scenery make_scenery(World const& world) {
    return {
        .arena = world.arena,
        .periodic = world.periodic,
        .categories = world.categories,
        .objects = world.objects,
        .body_radius_mm = world.bodies.radius_mm,
        .body_shape = world.bodies.shape,
        .robot_body = world.robots.body,
        .robot_category = world.robots.category,
        .robot_id = world.robots.id,
        .outlines = world.outlines,
    };
}

Vec2 minimum_image(Scenery const& scenery, Vec2 from_mm, Vec2 to_mm) {
    Vec2 d = to_mm - from_mm;
    if (scenery.periodic) {
        Vec2 const size = scenery.arena.bounds.size();
        d = d - Vec2{size.x * std::round(d.x / size.x), size.y * std::round(d.y / size.y)};
    }
    return d;
}

}  // namespace pogosim
