#include "physics/hull_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace pogosim {

namespace {

// Touches are sought within this distance, and what the bodies can close in a sub-step.
constexpr float kTouchReachMm = 1.0F;

Vec2 tangent_of(Vec2 normal) {
    return {-normal.y, normal.x};
}

}  // namespace

void HullContacts::clear() {
    contacts_.clear();
    hulls_.clear();
}

std::uint32_t HullContacts::hull_of(World const& world, NearContacts const& contacts, std::uint32_t body,
                                    std::uint32_t part, std::uint32_t mover, std::span<Mover const> movers) {
    auto const next = static_cast<std::uint32_t>(hulls_.size());
    if (mover == kStill) {
        Vec2 const place_mm = world.bodies.position_mm[body];
        Hull const own = contacts.hulls().of(world, body, part);
        hulls_.push_back({.own = own,
                          .now = placed(own, place_mm, world.bodies.heading_dir[body]),
                          .mover = mover,
                          .place_mm = place_mm});
        return next;
    }
    hull_of_mover_.resize(std::max(hull_of_mover_.size(), movers.size()));
    std::uint32_t const known = hull_of_mover_[mover];
    if (known < hulls_.size() && hulls_[known].mover == mover) {
        return known + part;
    }
    hull_of_mover_[mover] = next;
    for (std::uint32_t k = 0; k < contacts.hulls().part_count(body); ++k) {
        hulls_.push_back({.own = contacts.hulls().of(world, body, k),
                          .now = {},
                          .mover = mover,
                          .place_mm = movers[mover].position_mm});
    }
    return next + part;
}

void HullContacts::add(World const& world, NearContacts const& contacts, std::uint32_t index, std::uint32_t a,
                       std::uint32_t b, std::span<Mover const> movers) {
    NearContact const& near = contacts.near()[index];
    TouchingParts const& parts = contacts.parts(index);
    bool const is_wall = contacts.is_wall(index);
    Contact contact{.a = a,
                    .b = b,
                    .index = index,
                    .hull_a = hull_of(world, contacts, near.a, parts.a, a, movers),
                    .hull_b = is_wall ? kNone : hull_of(world, contacts, near.b, parts.b, b, movers),
                    .friction = near.law.friction,
                    .restitution = near.law.restitution,
                    .seam_mm = {}};
    if (world.periodic && !is_wall) {
        Vec2 const from_mm = hulls_[contact.hull_b].place_mm;
        Vec2 const to_mm = movers[a].position_mm;
        contact.seam_mm = minimum_image(world, from_mm, to_mm) - (to_mm - from_mm);
    }
    contacts_.push_back(contact);
}

Manifold HullContacts::touches(NearContacts const& contacts, Contact const& contact, float reach_mm) const {
    Placed const& a = hulls_[contact.hull_a];
    if (contact.hull_b == kNone) {
        return touches_with(a.now, contacts.wall_side(contact.index), reach_mm);
    }
    Hull const& b = hulls_[contact.hull_b].now;
    if (contact.seam_mm == Vec2{}) {
        return touches_of(a.now, b, reach_mm);
    }
    return touches_of(a.now, placed(b, -contact.seam_mm, {1.0F, 0.0F}), reach_mm);
}

bool HullContacts::measure(NearContacts const& contacts, std::span<Mover const> movers, Times const& times) {
    for (Placed& hull : hulls_) {
        if (hull.mover != kStill) {
            hull.place_mm = movers[hull.mover].position_mm;
            hull.now = placed(hull.own, hull.place_mm, direction(movers[hull.mover].heading_rad));
        }
    }
    bool overlaps = false;
    for (Contact& contact : contacts_) {
        Mover const& a = movers[contact.a];
        Mover const& b = movers[contact.b];
        float const closing_mm_s = length(a.velocity_mm_s - b.velocity_mm_s) +
                                   std::abs(a.angular_velocity_rad_s) * a.radius_mm +
                                   std::abs(b.angular_velocity_rad_s) * b.radius_mm;
        float const reach_mm = kTouchReachMm + times.h_s * closing_mm_s;
        overlaps = measure(contact, touches(contacts, contact, reach_mm), movers, times) || overlaps;
    }
    return overlaps;
}

bool HullContacts::measure(Contact& contact, Manifold const& touches, std::span<Mover const> movers,
                           Times const& times) const {
    Mover const& a = movers[contact.a];
    Mover const& b = movers[contact.b];
    contact.normal = touches.normal;
    contact.count = touches.count;
    bool overlaps = false;
    for (std::uint32_t i = 0; i < touches.count; ++i) {
        ManifoldPoint const& touch = touches.touch[i];
        Point& point = contact.points[i];
        Vec2 const b_mm = contact.hull_b == kNone ? Vec2{} : hulls_[contact.hull_b].place_mm - contact.seam_mm;
        point = {.arm_a_mm = touch.point_mm - hulls_[contact.hull_a].place_mm,
                 .arm_b_mm = touch.point_mm - b_mm,
                 .features = touch.features};
        Vec2 const velocity_mm_s = velocity_between(a, b, point.arm_a_mm, point.arm_b_mm);
        auto const [least, relaxed, latest] =
            demand_of(touch.gap_mm, dot(velocity_mm_s, touches.normal), contact.restitution, times);
        point.least_mm_s = least;
        point.relaxed_mm_s = relaxed;
        point.latest_mm_s = latest;
        point.normal_mass = 1.0F / inverse_mass(a, b, point.arm_a_mm, point.arm_b_mm, touches.normal);
        point.tangent_mass = 1.0F / inverse_mass(a, b, point.arm_a_mm, point.arm_b_mm, tangent_of(touches.normal));
        overlaps = overlaps || touch.gap_mm < -kContactToleranceMm;
    }
    return overlaps;
}

void HullContacts::push_as_before(NearContacts& contacts, std::span<Mover> movers) {
    for (Contact& contact : contacts_) {
        HullImpulse const& before = contacts.hull_impulse()[contact.index - contacts.first_hull()];
        for (Point& point : std::span(contact.points).first(contact.count)) {
            for (HullImpulse::Part const& part : before.parts) {
                if (part.normal > 0.0F && part.features == point.features) {
                    point.impulse = part;
                    Vec2 const impulse = part.normal * contact.normal + part.tangent * tangent_of(contact.normal);
                    push(movers[contact.a], point.arm_a_mm, impulse);
                    push(movers[contact.b], point.arm_b_mm, -impulse);
                    break;
                }
            }
        }
    }
}

void HullContacts::keep_impulses(NearContacts& contacts) const {
    for (Contact const& contact : contacts_) {
        HullImpulse& kept = contacts.hull_impulse()[contact.index - contacts.first_hull()];
        kept = {};
        for (std::uint32_t i = 0; i < contact.count; ++i) {
            kept.parts[i] = contact.points[i].impulse;
            kept.parts[i].features = contact.points[i].features;
        }
    }
}

/// As IslandSolver::solve_contact(), with arms.
float HullContacts::solve(Contact const& contact, Point& point, std::span<Mover> movers, bool pushes) {
    Mover& a = movers[contact.a];
    Mover& b = movers[contact.b];
    Vec2 const velocity_mm_s = velocity_between(a, b, point.arm_a_mm, point.arm_b_mm);
    float const speed_mm_s = dot(velocity_mm_s, contact.normal);
    float const demanded_mm_s = pushes ? point.least_mm_s : point.relaxed_mm_s;
    HullImpulse::Part const before = point.impulse;
    bool const waits = speed_mm_s > point.latest_mm_s && speed_mm_s < -kRestitutionThresholdMmS;
    float const change_mm_s = waits ? 0.0F : demanded_mm_s - speed_mm_s;
    point.impulse.normal = std::max(before.normal + point.normal_mass * change_mm_s, 0.0F);
    float const most = contact.friction * point.impulse.normal;
    float const slip_mm_s = dot(velocity_mm_s, tangent_of(contact.normal));
    point.impulse.tangent = std::clamp(before.tangent - point.tangent_mass * slip_mm_s, -most, most);
    float const pushed = point.impulse.normal - before.normal;
    float const rubbed = point.impulse.tangent - before.tangent;
    if (pushed == 0.0F && rubbed == 0.0F) {
        return 0.0F;
    }
    Vec2 const impulse = pushed * contact.normal + rubbed * tangent_of(contact.normal);
    push(a, point.arm_a_mm, impulse);
    push(b, point.arm_b_mm, -impulse);
    return std::abs(pushed) / point.normal_mass;
}

float HullContacts::solve(std::span<Mover> movers, bool backwards, bool pushes) {
    float most_mm_s = 0.0F;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        Contact& contact = contacts_[backwards ? contacts_.size() - 1 - i : i];
        for (Point& point : std::span(contact.points).first(contact.count)) {
            most_mm_s = std::max(most_mm_s, solve(contact, point, movers, pushes));
        }
    }
    return most_mm_s;
}

}  // namespace pogosim
