#include "physics/near_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "physics/body_mass.hpp"
#include "physics/membrane_mass.hpp"

namespace pogosim {

namespace {

ContactLaw law_between(Disk const& a, Disk const& b) {
    float const inverse_mass = a.inverse_mass + b.inverse_mass;
    float const inverse_tangent_mass =
        inverse_mass + a.radius_mm * a.radius_mm * a.inverse_inertia + b.radius_mm * b.radius_mm * b.inverse_inertia;
    return {.radius_mm = a.radius_mm + b.radius_mm,
            .normal_mass = 1.0F / inverse_mass,
            .inverse_normal_mass = inverse_mass,
            .tangent_mass = 1.0F / inverse_tangent_mass,
            .friction = std::sqrt(a.friction * b.friction),
            .restitution = std::max(a.restitution, b.restitution)};
}

}  // namespace

NearContacts::NearContacts(World const& world, WallSpec const& walls, std::shared_ptr<WallSides const> sides)
    : membranes_(world),
      hulls_(world),
      wall_{.radius_mm = 0.0F,
            .inverse_mass = 0.0F,
            .inverse_inertia = 0.0F,
            .friction = walls.friction,
            .restitution = walls.restitution},
      spring_impulse_(world.joints.size()),
      sides_(std::move(sides)) {
    Bodies const& bodies = world.bodies;
    std::vector<float> mass;
    std::vector<float> gyration_mm2;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        float const radius_mm = bodies.radius_mm[i];
        auto const body = static_cast<std::uint32_t>(i);
        if (hulls_.is_one(body)) {
            auto const [area_mm2, of_area_mm2] = mass_of(bodies.shape[i]);
            mass.push_back(bodies.spec[i].density * area_mm2);
            gyration_mm2.push_back(of_area_mm2);
        } else {
            mass.push_back(bodies.spec[i].density * std::numbers::pi_v<float> * radius_mm * radius_mm);
            gyration_mm2.push_back(0.5F * radius_mm * radius_mm);
        }
    }
    add_mass_to_membranes(world, mass);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        BodySpec const& spec = bodies.spec[i];
        float const radius_mm = bodies.radius_mm[i];
        bool const is_fixed_hull = spec.fixed && hulls_.is_one(static_cast<std::uint32_t>(i));
        disks_.push_back({.radius_mm = is_fixed_hull ? 0.0F : radius_mm,
                          .inverse_mass = spec.fixed ? 0.0F : 1.0F / mass[i],
                          .inverse_inertia = spec.fixed ? 0.0F : 1.0F / (mass[i] * gyration_mm2[i]),
                          .friction = spec.friction,
                          .restitution = spec.restitution});
    }
}

/// The bounding disk of a polygon may be much larger than the polygon.
void NearContacts::add_fixed(World const& world, std::uint32_t disk, std::uint32_t fixed, float skin_mm) {
    float const reach_mm = disks_[disk].radius_mm + skin_mm;
    for (std::uint32_t part = 0; part < hulls_.part_count(fixed); ++part) {
        if (!hulls_.is_one(fixed) ||
            hulls_.gap_to(world, fixed, part, world.bodies.position_mm[disk]).distance_mm < reach_mm) {
            with_fixed_.push_back({.a = disk, .b = fixed, .law = law_between(disks_[disk], disks_[fixed])});
            fixed_part_.push_back(part);
        }
    }
}

void NearContacts::build(World const& world, Assemblies const& assemblies, NeighbourList const& pairs,
                         WallNeighbourList const& walls) {
    keep_impulses();
    near_.clear();
    with_fixed_.clear();
    fixed_part_.clear();
    for (auto const [a, b] : pairs.pairs()) {
        if (!may_collide(assemblies, a, b) || is_movable_hull(a) || is_movable_hull(b)) {
            continue;
        }
        if (is_fixed(a)) {
            add_fixed(world, b, a, pairs.skin_mm());
        } else if (is_fixed(b)) {
            add_fixed(world, a, b, pairs.skin_mm());
        } else {
            near_.push_back({.a = a, .b = b, .law = law_between(disks_[a], disks_[b])});
        }
    }
    pair_count_ = static_cast<std::uint32_t>(near_.size());
    near_.insert(near_.end(), with_fixed_.begin(), with_fixed_.end());
    first_wall_ = static_cast<std::uint32_t>(near_.size());
    for (auto const [body, edge] : walls.walls()) {
        if (!hulls_.is_one(body)) {
            near_.push_back({.a = body, .b = edge, .law = law_between(disks_[body], wall_)});
        }
    }
    hull_parts_.clear();
    first_hull_ = first_hull_fixed_ = first_hull_wall_ = static_cast<std::uint32_t>(near_.size());
    if (!hulls_.empty()) {
        add_hulls(assemblies, pairs, walls);
    }
    give_impulses();
}

void NearContacts::add_hulls(Assemblies const& assemblies, NeighbourList const& pairs, WallNeighbourList const& walls) {
    with_fixed_.clear();
    parts_with_fixed_.clear();
    for (auto const [a, b] : pairs.pairs()) {
        if (!may_collide(assemblies, a, b) || !(is_movable_hull(a) || is_movable_hull(b))) {
            continue;
        }
        NearContact const near{
            .a = is_fixed(a) ? b : a, .b = is_fixed(a) ? a : b, .law = law_between(disks_[a], disks_[b])};
        for (std::uint32_t part_a = 0; part_a < hulls_.part_count(near.a); ++part_a) {
            for (std::uint32_t part_b = 0; part_b < hulls_.part_count(near.b); ++part_b) {
                (is_fixed(near.b) ? with_fixed_ : near_).push_back(near);
                (is_fixed(near.b) ? parts_with_fixed_ : hull_parts_).push_back({part_a, part_b});
            }
        }
    }
    first_hull_fixed_ = static_cast<std::uint32_t>(near_.size());
    near_.insert(near_.end(), with_fixed_.begin(), with_fixed_.end());
    hull_parts_.insert(hull_parts_.end(), parts_with_fixed_.begin(), parts_with_fixed_.end());
    first_hull_wall_ = static_cast<std::uint32_t>(near_.size());
    for (auto const [body, edge] : walls.walls()) {
        for (std::uint32_t part = 0; hulls_.is_one(body) && part < hulls_.part_count(body); ++part) {
            near_.push_back({.a = body, .b = edge, .law = law_between(disks_[body], wall_)});
            hull_parts_.push_back({part, 0});
        }
    }
}

/// Symmetric in the two bodies, with no impulse.
NearContacts::Pushing NearContacts::named(std::uint32_t contact) const {
    auto const [a, b, law] = near_[contact];
    constexpr std::uint64_t walls = std::uint64_t{1} << 63U;
    if (is_wall(contact)) {
        return {.things = walls | std::uint64_t{a} << 32U | b,
                .parts = contact < first_hull_ ? 0 : parts(contact).a,
                .impulse = 0.0F,
                .of_hull = {}};
    }
    TouchingParts touching;
    if (contact >= first_hull_) {
        touching = parts(contact);
    } else if (contact >= pair_count_) {
        touching.b = fixed_part_[contact - pair_count_];
    }
    return {.things = std::uint64_t{std::min(a, b)} << 32U | std::max(a, b),
            .parts = a < b ? touching.a << 16U | touching.b : touching.b << 16U | touching.a,
            .impulse = 0.0F,
            .of_hull = {}};
}

void NearContacts::keep_impulses() {
    pushing_.clear();
    pushes_.assign(disks_.size(), 0);
    auto const keep = [this](std::uint32_t contact, float impulse, HullImpulse const& of_hull) {
        pushing_.push_back(named(contact));
        pushing_.back().impulse = impulse;
        pushing_.back().of_hull = of_hull;
        pushes_[near_[contact].a] = 1;
        if (!is_wall(contact)) {
            pushes_[near_[contact].b] = 1;
        }
    };
    for (std::uint32_t i = 0; i < first_hull_; ++i) {
        if (driven_impulse_[i] > 0.0F) {
            keep(i, driven_impulse_[i], {});
        }
    }
    for (std::uint32_t i = first_hull_; i < near_.size(); ++i) {
        HullImpulse const& impulse = hull_impulse_[i - first_hull_];
        if (impulse.parts[0].normal > 0.0F || impulse.parts[1].normal > 0.0F) {
            keep(i, 0.0F, impulse);
        }
    }
    std::ranges::sort(pushing_, std::less{}, &Pushing::name);
}

void NearContacts::give_impulses() {
    driven_impulse_.assign(first_hull_, 0.0F);
    hull_impulse_.assign(near_.size() - first_hull_, {});
    for (std::uint32_t i = 0; i < near_.size(); ++i) {
        if (pushes_[near_[i].a] == 0) {
            continue;
        }
        auto const name = named(i).name();
        auto const known = std::ranges::lower_bound(pushing_, name, std::less{}, &Pushing::name);
        if (known != pushing_.end() && known->name() == name) {
            if (i < first_hull_) {
                driven_impulse_[i] = known->impulse;
            } else {
                hull_impulse_[i - first_hull_] = known->of_hull;
            }
        }
    }
}

std::optional<Gap> NearContacts::gap_to_fixed(World const& world, std::uint32_t contact, Vec2 point_mm) const {
    std::uint32_t const fixed = near_[contact].b;
    if (contact >= first_wall_) {
        return gap_to((*sides_)[fixed], point_mm);
    }
    if (hulls_.is_one(fixed)) {
        return hulls_.gap_to(world, fixed, fixed_part_[contact - pair_count_], point_mm);
    }
    return gap_to_centre(minimum_image(world, world.bodies.position_mm[fixed], point_mm));
}

float NearContacts::gap_of_hull_mm(World const& world, std::uint32_t contact, float beyond_mm) const {
    auto const [a, b, law] = near_[contact];
    auto const [part_a, part_b] = parts(contact);
    Vec2 const place_mm = world.bodies.position_mm[a];
    auto const around = [&](std::uint32_t body, std::uint32_t part) {
        auto const [centre_mm, radius_mm] = hulls_.around(world, body, part);
        return Hulls::Around{rotate(centre_mm, world.bodies.heading_dir[body]), radius_mm};
    };
    Hulls::Around const around_a = around(a, part_a);
    if (is_wall(contact)) {
        return distance_to(wall_side(contact), place_mm + around_a.centre_mm) - around_a.radius_mm;
    }
    // About the centre of `a`, which may be on the other side of a seam.
    Vec2 const to_b_mm = minimum_image(world, place_mm, world.bodies.position_mm[b]);
    Hulls::Around const around_b = around(b, part_b);
    float const between_disks_mm =
        length(to_b_mm + around_b.centre_mm - around_a.centre_mm) - around_a.radius_mm - around_b.radius_mm;
    if (between_disks_mm >= beyond_mm) {
        return between_disks_mm;
    }
    return gap_between_mm(placed(hulls_.of(world, a, part_a), {}, world.bodies.heading_dir[a]),
                          placed(hulls_.of(world, b, part_b), to_b_mm, world.bodies.heading_dir[b]));
}

}  // namespace pogosim
