// Worlds made by hand, for tests of single stages.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "world/world.hpp"

namespace pogosim::testing {

/// An empty square arena of the given side, mm.
inline World square_world(float side_mm = 1000.0F) {
    World world;
    world.arena.polygons = {{{0, 0}, {side_mm, 0}, {side_mm, side_mm}, {0, side_mm}}};
    world.arena.bounds = {{0, 0}, {side_mm, side_mm}};
    world.arena.area_mm2 = static_cast<double>(side_mm) * static_cast<double>(side_mm);
    return world;
}

/// Radius, range and body as the article's configuration has them.
inline ObjectSpec pogobot_spec() {
    ObjectSpec spec;
    spec.shape.radius_mm = 26.5F;
    spec.body.emplace();
    spec.robot.emplace();
    return spec;
}

/// Adds a body and returns its index.
inline std::uint32_t add_body(World& world, Vec2 position_mm, float heading_rad, ObjectSpec const& spec) {
    world.bodies.position_mm.push_back(position_mm);
    world.bodies.heading_rad.push_back(heading_rad);
    world.bodies.heading_dir.push_back(direction(heading_rad));
    world.bodies.velocity_mm_s.push_back({});
    world.bodies.angular_velocity_rad_s.push_back(0.0F);
    world.bodies.radius_mm.push_back(bounding_radius(spec.shape));
    world.bodies.shape.push_back(spec.shape);
    world.bodies.spec.push_back(*spec.body);
    return static_cast<std::uint32_t>(world.bodies.size()) - 1;
}

/// Adds a robot of the world's only category (made on the first call) and returns its index.
inline std::uint32_t add_robot(World& world, Vec2 position_mm, float heading_rad = 0.0F,
                               ObjectSpec const& spec = pogobot_spec()) {
    if (world.categories.empty()) {
        world.categories.push_back({"robots", spec});
    }
    auto const index = static_cast<std::uint32_t>(world.robots.size());
    world.robots.id.push_back(index);
    world.robots.category.push_back(0);
    world.robots.body.push_back(index);
    world.robots.led.push_back({});
    world.robots.command.push_back({});
    world.robots.stream.emplace_back(1, index);
    add_body(world, position_mm, heading_rad, spec);
    world.objects.push_back({.id = index, .robot = index, .body = index, .body_count = 1});
    std::vector<int> const sizes(world.robots.size(), spec.robot->ir.queue_size);
    world.mailboxes = Mailboxes(sizes, 382);
    return index;
}

inline std::uint32_t add_outline(World& world, Outline outline, float range_mm) {
    ObjectSpec spec;
    spec.robot.emplace();
    spec.robot->emitters = Emitters::outline;
    spec.robot->ir.range_mm = range_mm;
    auto const robot = static_cast<std::uint32_t>(world.robots.size());
    world.robots.id.push_back(65535);
    world.robots.category.push_back(static_cast<std::uint32_t>(world.categories.size()));
    world.robots.body.push_back(outline.body);
    world.robots.led.push_back({});
    world.robots.command.push_back({});
    world.robots.stream.emplace_back(1, robot);
    world.categories.push_back({"outlines", spec});
    outline.robot = robot;
    world.outlines.push_back(std::move(outline));
    world.mailboxes = Mailboxes(std::vector<int>(world.robots.size(), spec.robot->ir.queue_size), 382);
    return robot;
}

/// A robot whose outline is all of these polygons.
inline std::uint32_t add_wall(World& world, std::vector<Polygon> polygons, float range_mm = 80.0F) {
    return add_outline(world, {.robot = 0, .polygons = std::move(polygons)}, range_mm);
}

/// A membrane of bodies at these places, without other properties. Add it after all robots.
inline std::uint32_t add_membrane(World& world, Polygon const& dots, float range_mm = 80.0F) {
    auto const first = static_cast<std::uint32_t>(world.bodies.size());
    world.bodies.position_mm.insert(world.bodies.position_mm.end(), dots.begin(), dots.end());
    return add_outline(
        world, {.robot = 0, .polygons = {}, .body = first, .body_count = static_cast<std::uint32_t>(dots.size())},
        range_mm);
}

}  // namespace pogosim::testing
