#include "world/world.hpp"

#include <algorithm>
#include <cmath>

#include "world/light_cell.hpp"

namespace pogosim {

std::int16_t LightMap::at(Vec2 point_mm) const {
    return level[cell_under(*this, point_mm)];
}

std::size_t count_of_robots(World const& world) {
    std::size_t count = 0;
    for (std::size_t robot = 0; robot < world.robots.size(); ++robot) {
        count += world.spec_of(robot).model.sends_along_outline ? 0 : 1;
    }
    return count;
}

void set_pose(Bodies& bodies, std::uint32_t body, Vec2 position_mm, float heading_rad) {
    if (!is_finite(position_mm) || !std::isfinite(heading_rad)) {
        return;
    }
    float const wrapped_rad = wrap_angle(heading_rad);
    bool const is_moved = bodies.position_mm[body] != position_mm || bodies.heading_rad[body] != wrapped_rad;
    bodies.written.push_back({body, is_moved});
    bodies.position_mm[body] = position_mm;
    bodies.heading_rad[body] = wrapped_rad;
    bodies.heading_dir[body] = direction(heading_rad);
    bodies.velocity_mm_s[body] = {};
    bodies.angular_velocity_rad_s[body] = 0.0F;
    bodies.start_mm[body] = position_mm;
    bodies.start_rad[body] = wrapped_rad;
}

void set_velocity(Bodies& bodies, std::uint32_t body, Vec2 velocity_mm_s, float angular_velocity_rad_s) {
    bool const is_possible = is_finite(velocity_mm_s) && std::isfinite(angular_velocity_rad_s);
    if (!is_possible || bodies.spec[body].fixed) {
        return;
    }
    bodies.written.push_back({body, /*is_moved=*/false});
    bodies.velocity_mm_s[body] = velocity_mm_s;
    bodies.angular_velocity_rad_s[body] = angular_velocity_rad_s;
}

void set_pose(World& world, Object const& object, Vec2 centre_mm, float heading_rad) {
    Bodies& bodies = world.bodies;
    if (object.body_count == 1) {
        set_pose(bodies, object.body, centre_mm, heading_rad);
        return;
    }
    Vec2 const motion_mm = centre_mm - pogosim::centre_mm(world, object);
    for (std::uint32_t i = object.body; i < object.body + object.body_count; ++i) {
        set_pose(bodies, i, bodies.position_mm[i] + motion_mm, bodies.heading_rad[i]);
    }
}

bool is_alive(World const& world, std::uint32_t robot) {
    return !std::ranges::binary_search(world.switched_off, robot);
}

Vec2 centre_mm(World const& world, Object const& object) {
    if (object.body == kNone) {
        return object.fixed_mm;
    }
    // The position of the first body plus the mean offset from it, so that the result is exact for a single body.
    Vec2 const first = world.bodies.position_mm[object.body];
    Vec2 sum;
    for (std::uint32_t k = 1; k < object.body_count; ++k) {
        sum = sum + (world.bodies.position_mm[object.body + k] - first);
    }
    return first + (1.0F / static_cast<float>(object.body_count)) * sum;
}

Pose pose_of(World const& world, Object const& object) {
    bool const is_rigid = object.body_count == 1;
    return {.position_mm = wrapped(world, centre_mm(world, object)),
            .heading_rad = is_rigid ? wrap_angle(world.bodies.heading_rad[object.body]) : 0.0F};
}

Vec2 minimum_image_across(World const& world, Vec2 a, Vec2 b) {
    Vec2 d = b - a;
    Vec2 const size = world.arena.bounds.size();
    // Most points are nearer than half the size, so no rounding is necessary.
    if (std::abs(d.x) > 0.49F * size.x) {
        d.x -= size.x * std::round(d.x / size.x);
    }
    if (std::abs(d.y) > 0.49F * size.y) {
        d.y -= size.y * std::round(d.y / size.y);
    }
    return d;
}

Vec2 offset_into_bounds(World const& world, Vec2 point_mm) {
    Box const& bounds = world.arena.bounds;
    Vec2 const size = bounds.size();
    return {-size.x * std::floor((point_mm.x - bounds.min.x) / size.x),
            -size.y * std::floor((point_mm.y - bounds.min.y) / size.y)};
}

Vec2 wrapped(World const& world, Vec2 point_mm) {
    return world.periodic ? point_mm + offset_into_bounds(world, point_mm) : point_mm;
}

}  // namespace pogosim
