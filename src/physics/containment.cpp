#include "physics/containment.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/shape.hpp"

namespace pogosim {

namespace {

// A body is put back when it has sunk into a wall by this share of its inner radius.
constexpr float kSunkShare = 0.5F;
// A motion along walls ends at the third wall that it meets, or where two walls hold it in a corner.
constexpr int kMostWalls = 3;
// Walls further away than this many radii are not looked for.
constexpr float kLookRadii = 8.0F;
// Of a body, in parts of the largest coordinate: half of it is well above the rounding of float.
constexpr float kSmallestRadius = 8e-6F;

bool is_finite(b2Vec2 a) {
    return std::isfinite(a.x) && std::isfinite(a.y);
}

}  // namespace

Containment::Containment(World const& world) : walls_(world.arena) {
    Box const& box = world.arena.bounds;
    float const smallest_mm = kSmallestRadius * std::max({std::abs(box.min.x), std::abs(box.min.y), std::abs(box.max.x),
                                                          std::abs(box.max.y)});
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        leashes_.push_back({.last_mm = from_box2d(to_box2d(world.bodies.position_mm[i])),
                            .free_mm = 0.0F,
                            .radius_mm = std::max(inner_radius(world.bodies.shape[i]), smallest_mm)});
    }
}

void Containment::hold(std::vector<b2Body*> const& bodies) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        b2Body& body = *bodies[i];
        if (!body.IsAwake() || body.GetType() == b2_staticBody) {
            continue;
        }
        Leash& leash = leashes_[i];
        Vec2 const place_mm = from_box2d(body.GetPosition());
        Vec2 const motion_mm = place_mm - leash.last_mm;
        float const moved_mm = std::abs(motion_mm.x) + std::abs(motion_mm.y);  // at most
        if (moved_mm < leash.free_mm) {
            leash.free_mm -= moved_mm;
            leash.last_mm = place_mm;
        } else {
            look_at_walls(body, leash, motion_mm);
        }
    }
}

void Containment::start_from(std::vector<b2Body*> const& bodies) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        leashes_[i].last_mm = from_box2d(bodies[i]->GetPosition());
        leashes_[i].free_mm = 0.0F;
    }
}

void Containment::look_at_walls(b2Body& body, Leash& leash, Vec2 motion_mm) const {
    float const least_mm = kSunkShare * leash.radius_mm;
    if (!is_finite(body.GetPosition()) || !std::isfinite(body.GetAngle())) {
        body.SetTransform(to_box2d(leash.last_mm), 0.0F);
        body.SetLinearVelocity(b2Vec2_zero);
        body.SetAngularVelocity(0.0F);
    } else if (walls_.first_touch(leash.last_mm, motion_mm, least_mm)) {
        slide(body, leash, motion_mm);
    }
    leash.last_mm = from_box2d(body.GetPosition());
    leash.free_mm = walls_.distance(leash.last_mm, kLookRadii * leash.radius_mm) - least_mm;
}

void Containment::slide(b2Body& body, Leash const& leash, Vec2 motion_mm) const {
    Vec2 place_mm = leash.last_mm;
    for (int wall = 0; wall < kMostWalls; ++wall) {
        std::optional<WallTouch> const touch = walls_.first_touch(place_mm, motion_mm, leash.radius_mm);
        if (!touch) {
            place_mm = place_mm + motion_mm;
            break;
        }
        auto const fraction = static_cast<float>(touch->fraction);
        place_mm = place_mm + fraction * motion_mm;
        motion_mm = (1.0F - fraction) * motion_mm;
        motion_mm = motion_mm - dot(motion_mm, touch->normal) * touch->normal;
    }
    body.SetTransform(to_box2d(place_mm), body.GetAngle());
}

}  // namespace pogosim
