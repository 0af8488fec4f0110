// What is measured on crowds of disks and hulls.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "physics/body_mass.hpp"
#include "physics/hulls.hpp"
#include "physics/physics_engine.hpp"
#include "support/small_world.hpp"
#include "world/world.hpp"

namespace pogosim::testing {

/// Adds a robot of any shape.
inline std::uint32_t add_body(World& world, Shape const& shape, Vec2 place_mm, float heading_rad,
                              BodySpec const& body = {}) {
    ObjectSpec spec;
    spec.shape = shape;
    spec.robot.emplace();
    spec.body = body;
    return add_robot(world, place_mm, heading_rad, spec);
}

/// The parts of a shape at a pose.
inline std::vector<Hull> hulls_at(Shape const& shape, Vec2 place_mm, float heading_rad) {
    std::vector<Hull> hulls;
    for (RoundedPolygon const& part : convex_parts(shape)) {
        Hull own = hull_of(part);
        own.count = shape.kind == ShapeKind::disk ? 1 : own.count;
        hulls.push_back(placed(own, place_mm, direction(heading_rad)));
    }
    return hulls;
}

/// The same of what is convex.
inline Hull hull_at(Shape const& shape, Vec2 place_mm, float heading_rad) {
    return hulls_at(shape, place_mm, heading_rad).front();
}

inline float gap_mm(World const& world, std::uint32_t a, std::uint32_t b) {
    Bodies const& bodies = world.bodies;
    Vec2 const to_b_mm = minimum_image(world, bodies.position_mm[a], bodies.position_mm[b]);
    if (bodies.shape[a].kind == ShapeKind::disk && bodies.shape[b].kind == ShapeKind::disk) {
        return length(to_b_mm) - bodies.radius_mm[a] - bodies.radius_mm[b];
    }
    float least_mm = std::numeric_limits<float>::max();
    for (Hull const& one : hulls_at(bodies.shape[a], {}, bodies.heading_rad[a])) {
        for (Hull const& other : hulls_at(bodies.shape[b], to_b_mm, bodies.heading_rad[b])) {
            least_mm = std::min(least_mm, gap_between_mm(one, other));
        }
    }
    return least_mm;
}

/// With each other, and with the walls of a rectangular arena.
inline float deepest_overlap_mm(World const& world) {
    float deepest_mm = 0.0F;
    Bodies const& bodies = world.bodies;
    Box const& box = world.arena.bounds;
    for (std::uint32_t a = 0; a < bodies.size(); ++a) {
        for (std::uint32_t b = a + 1; b < bodies.size(); ++b) {
            float const reach_mm = bodies.radius_mm[a] + bodies.radius_mm[b];
            if (length(minimum_image(world, bodies.position_mm[a], bodies.position_mm[b])) < reach_mm) {
                deepest_mm = std::max(deepest_mm, -gap_mm(world, a, b));
            }
        }
        for (Hull const& hull : hulls_at(bodies.shape[a], bodies.position_mm[a], bodies.heading_rad[a])) {
            for (std::uint32_t k = 0; k < hull.count && !world.periodic; ++k) {
                Vec2 const corner = hull.corner_mm[k];
                deepest_mm =
                    std::max({deepest_mm, hull.radius_mm + box.min.x - corner.x, hull.radius_mm + box.min.y - corner.y,
                              hull.radius_mm + corner.x - box.max.x, hull.radius_mm + corner.y - box.max.y});
            }
        }
    }
    return deepest_mm;
}

/// The deepest overlap while motors drive all robots this way, in every second step.
inline float deepest_when_all_push_mm(World& world, PhysicsEngine& engine, Vec2 velocity_mm_s, int steps) {
    float deepest_mm = 0.0F;
    for (int step = 0; step < steps; ++step) {
        for (VelocityCommand& command : world.robots.command) {
            command = {.velocity_mm_s = velocity_mm_s, .pending = step % 2 == 0};
        }
        engine.advance(world);
        deepest_mm = std::max(deepest_mm, deepest_overlap_mm(world));
    }
    return deepest_mm;
}

/// Twice the kinetic energy, in units of the density.
inline double energy(World const& world) {
    double sum = 0.0;
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        ShapeMass const of = mass_of(world.bodies.shape[i]);
        double const w = world.bodies.angular_velocity_rad_s[i];
        sum += of.area_mm2 * (squared_length(world.bodies.velocity_mm_s[i]) + of.gyration_mm2 * w * w);
    }
    return sum;
}

struct Extremes {
    double highest_energy = 0.0;
    float deepest_overlap_mm = 0.0F;
};

/// During so many steps.
inline Extremes extremes_in(World& world, PhysicsEngine& engine, int steps) {
    Extremes extremes;
    for (int step = 0; step < steps; ++step) {
        engine.advance(world);
        extremes.highest_energy = std::max(extremes.highest_energy, energy(world));
        extremes.deepest_overlap_mm = std::max(extremes.deepest_overlap_mm, deepest_overlap_mm(world));
    }
    return extremes;
}

}  // namespace pogosim::testing
