#include "world/blocker.hpp"

#include <utility>

#include "geometry/shape.hpp"

namespace pogosim {

namespace {

constexpr int kCornersOfATurn = 32;  // of rounded corners

void add_rigid(Shape const& shape, std::uint32_t body, std::vector<Blocker>& blockers) {
    if (shape.kind == ShapeKind::disk) {
        blockers.push_back({.body = body});
        return;
    }
    for (Polygon& part : outlines(shape, kCornersOfATurn)) {
        blockers.push_back({.body = body, .corners = std::move(part)});
    }
}

}  // namespace

std::vector<Blocker> blockers_of(World const& world, bool BodySpec::*blocks) {
    std::vector<BodySpec> const& specs = world.bodies.spec;
    std::vector<Blocker> blockers;
    std::vector<bool> is_in_membrane(specs.size(), false);
    for (Membrane const& membrane : world.membranes) {
        for (std::uint32_t k = 0; k < membrane.body_count; ++k) {
            std::uint32_t const body = membrane.body + k;
            is_in_membrane[body] = true;
            if (specs[body].*blocks) {
                blockers.push_back({.body = body, .next_body = membrane.body + (k + 1) % membrane.body_count});
            }
        }
    }
    for (std::uint32_t body = 0; body < specs.size(); ++body) {
        if (specs[body].*blocks && !is_in_membrane[body]) {
            add_rigid(world.bodies.shape[body], body, blockers);
        }
    }
    return blockers;
}

BlockerPose pose_of(World const& world, Blocker const& blocker) {
    Bodies const& bodies = world.bodies;
    Vec2 const position_mm = bodies.position_mm[blocker.body];
    if (blocker.next_body == kNone) {
        return {position_mm, bodies.heading_dir[blocker.body], bodies.radius_mm[blocker.body]};
    }
    Vec2 const half_mm = 0.5F * minimum_image(world, position_mm, bodies.position_mm[blocker.next_body]);
    return {position_mm + half_mm, half_mm, length(half_mm)};
}

}  // namespace pogosim
