#include "physics/membrane_sides.hpp"

#include <algorithm>

namespace pogosim {

namespace {

bool is_part(Membrane const& membrane, std::size_t body) {
    return body >= membrane.body && body < std::size_t{membrane.body} + membrane.body_count;
}

/// Widest gap that the springs of a membrane leave between two of its bodies, mm.
float widest_gap_mm(World const& world, Membrane const& membrane) {
    float widest_mm = 0.0F;
    for (Joint const& joint : world.joints) {
        if (joint.max_stretch > 0.0F && is_part(membrane, joint.a)) {
            widest_mm = std::max(widest_mm, (1.0F + joint.max_stretch) * joint.length_mm -
                                                world.bodies.radius_mm[joint.a] - world.bodies.radius_mm[joint.b]);
        }
    }
    return widest_mm;
}

}  // namespace

MembraneSides::MembraneSides(World const& world, std::vector<b2Body*> const& bodies) {
    for (Membrane const& membrane : world.membranes) {
        Side& side = sides_.emplace_back();
        side.membrane = membrane;
        float const gap_mm = widest_gap_mm(world, membrane);
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            if (!is_part(membrane, i) && 2.0F * world.bodies.radius_mm[i] >= gap_mm) {
                side.others.push_back(static_cast<std::uint32_t>(i));
            }
        }
    }
    look_again(bodies);
}

bool MembraneSides::hold(std::vector<b2Body*> const& bodies) {
    bool const crossed = somebody_crossed(bodies);
    if (crossed) {
        for (Side const& side : sides_) {
            for (std::size_t k = 0; k < side.others.size(); ++k) {
                if (side.is_inside[k] != side.was_inside[k]) {
                    put_back(bodies, side.others[k]);
                }
            }
        }
        if (somebody_crossed(bodies)) {
            for (std::size_t i = 0; i < bodies.size(); ++i) {
                put_back(bodies, i);
            }
        }
    }
    remember_poses(bodies);
    return crossed;
}

void MembraneSides::look_again(std::vector<b2Body*> const& bodies) {
    for (Side& side : sides_) {
        find_sides(bodies, side);
        side.was_inside = side.is_inside;
    }
    remember_poses(bodies);
}

bool MembraneSides::somebody_crossed(std::vector<b2Body*> const& bodies) {
    bool crossed = false;
    for (Side& side : sides_) {
        find_sides(bodies, side);
        crossed = crossed || side.is_inside != side.was_inside;
    }
    return crossed;
}

void MembraneSides::find_sides(std::vector<b2Body*> const& bodies, Side& side) {
    line_.clear();
    for (std::uint32_t k = 0; k < side.membrane.body_count; ++k) {
        line_.push_back(from_box2d(bodies[side.membrane.body + k]->GetPosition()));
    }
    Box const box = bounding_box(line_);
    side.is_inside.assign(side.others.size(), 0);
    for (std::size_t k = 0; k < side.others.size(); ++k) {
        Vec2 const place_mm = from_box2d(bodies[side.others[k]]->GetPosition());
        if (box.contains(place_mm) && contains(line_, place_mm)) {
            side.is_inside[k] = 1;
        }
    }
}

void MembraneSides::put_back(std::vector<b2Body*> const& bodies, std::size_t i) const {
    b2Body& body = *bodies[i];
    body.SetTransform(poses_[i].position, poses_[i].angle_rad);
    body.SetLinearVelocity(b2Vec2_zero);
    body.SetAngularVelocity(0.0F);
}

void MembraneSides::remember_poses(std::vector<b2Body*> const& bodies) {
    poses_.clear();
    for (b2Body const* body : bodies) {
        poses_.push_back({body->GetPosition(), body->GetAngle()});
    }
}

}  // namespace pogosim
