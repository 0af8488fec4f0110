#include "sim/touching.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "geometry/polygon.hpp"
#include "geometry/shape.hpp"

namespace pogosim {

namespace {

/// A body that its motors press against something bounces back by up to this distance at each tick.
constexpr float kBounceMm = 1.5F;

std::vector<RoundedPolygon> parts_of(World const& world, std::uint32_t body) {
    Bodies const& bodies = world.bodies;
    std::vector<RoundedPolygon> parts = convex_parts(bodies.shape[body]);
    for (RoundedPolygon& part : parts) {
        part = moved(part, bodies.position_mm[body], bodies.heading_rad[body]);
    }
    return parts;
}

/// For outlines that do not cross: the smallest distance is between a corner of one and the other outline.
float distance_between(Polygon const& a, Polygon const& b, Vec2 shift_of_b) {
    float nearest = std::numeric_limits<float>::max();
    for (Vec2 const corner : a) {
        nearest = std::min(nearest, distance_to_outline(b, corner - shift_of_b));
    }
    for (Vec2 const corner : b) {
        nearest = std::min(nearest, distance_to_outline(a, corner + shift_of_b));
    }
    return nearest;
}

bool touch_walls(World const& world, std::uint32_t body, float gap_mm) {
    std::vector<RoundedPolygon> const parts = parts_of(world, body);
    return std::ranges::any_of(world.arena.polygons, [&](Polygon const& wall) {
        return std::ranges::any_of(parts, [&](RoundedPolygon const& part) {
            return distance_between(part.corners_mm, wall, {}) - part.radius_mm <= gap_mm;
        });
    });
}

bool touch(World const& world, std::uint32_t a, std::uint32_t b, float gap_mm) {
    Bodies const& bodies = world.bodies;
    Vec2 const way_mm = minimum_image(world, bodies.position_mm[a], bodies.position_mm[b]);
    float const reach_mm = bodies.radius_mm[a] + bodies.radius_mm[b] + gap_mm;
    if (!(squared_length(way_mm) <= reach_mm * reach_mm)) {
        return false;
    }
    Vec2 const shift_mm = bodies.position_mm[a] + way_mm - bodies.position_mm[b];
    for (RoundedPolygon const& one : parts_of(world, a)) {
        for (RoundedPolygon const& other : parts_of(world, b)) {
            float const margins_mm = one.radius_mm + other.radius_mm;
            if (distance_between(one.corners_mm, other.corners_mm, shift_mm) - margins_mm <= gap_mm) {
                return true;
            }
        }
    }
    return false;
}

}  // namespace

Touched touched_by(World const& world, Object const& object, TouchGaps const& gaps) {
    Touched touched;
    if (object.body == kNone) {
        return touched;
    }
    for (std::uint32_t a = object.body; a < object.body + object.body_count; ++a) {
        touched.wall = touched.wall || (!world.periodic && touch_walls(world, a, gaps.walls_mm + kBounceMm));
    }
    for (std::uint32_t i = 0; i < world.objects.size(); ++i) {
        Object const& other = world.objects[i];
        bool found = false;
        for (std::uint32_t b = other.body; &other != &object && b != kNone && b < other.body + other.body_count; ++b) {
            for (std::uint32_t a = object.body; a < object.body + object.body_count && !found; ++a) {
                found = touch(world, a, b, gaps.bodies_mm + kBounceMm);
            }
        }
        if (found) {
            touched.objects.push_back(i);
        }
    }
    return touched;
}

}  // namespace pogosim
