// Worlds made by hand, for tests of single stages.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
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
    world.bodies.start_mm.push_back(position_mm);
    world.bodies.start_rad.push_back(heading_rad);
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
    spec.robot->model = outline_model();
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

struct Sending {
    std::uint8_t emitters = kAllFaces;
    float send_probability = 1.0F;
    float range_mm = -1.0F;  // negative: the robot's own
};

/// Puts a message of a robot on the air.
inline void send(World& world, std::uint32_t robot, std::span<std::byte const> payload, Sending const& sending = {}) {
    Transmission transmission;
    transmission.robot = robot;
    transmission.emitters = sending.emitters;
    transmission.send_probability = sending.send_probability;
    transmission.range_mm = sending.range_mm < 0.0F ? world.spec_of(robot).ir.range_mm : sending.range_mm;
    transmission.header.sender_id = static_cast<std::uint16_t>(robot);
    transmission.header.payload_length = static_cast<std::uint16_t>(payload.size());
    transmission.message_bytes = static_cast<std::uint16_t>(payload.size() + 3);
    transmission.payload_offset = world.air.payloads.size();
    world.air.payloads.insert(world.air.payloads.end(), payload.begin(), payload.end());
    world.air.transmissions.push_back(transmission);
}

struct RingSpec {
    Vec2 centre_mm{500, 500};
    float radius_mm = 200.0F;
    std::uint32_t dots = 80;
    float dot_radius_mm = 10.0F;
    float damping_per_s = 0.0F;
    bool segments = false;  // rectangles joined by hinges, twice the radius thick
};

/// A round membrane that springs hold together, without a robot: a body, as add_body() makes it, for each dot. Each is
/// joined to the next one, and to the third one on.
inline Membrane add_ring(World& world, RingSpec const& ring) {
    ObjectSpec spec = pogobot_spec();
    spec.shape.radius_mm = ring.dot_radius_mm;
    spec.body = BodySpec{.linear_damping = ring.damping_per_s, .density = 10.0F, .friction = 0.3F, .restitution = 0.5F};
    Membrane const membrane{.body = static_cast<std::uint32_t>(world.bodies.size()), .body_count = ring.dots};
    auto const place_mm = [&](std::uint32_t k) {
        return ring.centre_mm +
               ring.radius_mm * direction(6.2831853F * static_cast<float>(k) / static_cast<float>(ring.dots));
    };
    float const side_mm = length(place_mm(1) - place_mm(0));
    if (ring.segments) {
        spec.shape = {.kind = ShapeKind::rectangle, .width_mm = side_mm, .height_mm = 2.0F * ring.dot_radius_mm};
    }
    for (std::uint32_t k = 0; k < ring.dots; ++k) {
        Vec2 const way_mm = place_mm(k + 1) - place_mm(k);
        Vec2 const middle_mm = place_mm(k) + 0.5F * way_mm;
        add_body(world, ring.segments ? middle_mm : place_mm(k), ring.segments ? std::atan2(way_mm.y, way_mm.x) : 0.0F,
                 spec);
    }
    for (std::uint32_t k = 0; k < ring.dots; ++k) {
        for (std::uint32_t const span : {1U, 3U}) {
            if (ring.segments && span == 1) {
                world.joints.push_back({.a = membrane.body + k,
                                        .b = membrane.body + (k + 1) % ring.dots,
                                        .anchor_a_mm = {0.5F * side_mm, 0.0F},
                                        .anchor_b_mm = {-0.5F * side_mm, 0.0F}});
                continue;
            }
            world.joints.push_back(
                {.a = membrane.body + k,
                 .b = membrane.body + (k + span) % ring.dots,
                 .anchor_a_mm = {},
                 .anchor_b_mm = {},
                 .length_mm = length(world.bodies.position_mm[membrane.body + (k + span) % ring.dots] -
                                     world.bodies.position_mm[membrane.body + k]),
                 .stiffness_hz = span == 1 ? 30.0F : 24.0F,
                 .damping_ratio = 0.3F,
                 .max_stretch = span == 1 ? 0.05F : 0.0F});
        }
    }
    world.membranes.push_back(membrane);
    world.objects.push_back({.id = static_cast<std::uint32_t>(world.objects.size()),
                             .body = membrane.body,
                             .body_count = membrane.body_count});
    return membrane;
}

}  // namespace pogosim::testing
