#include "physics/disk_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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

DiskContacts::DiskContacts(World const& world, WallSpec const& walls)
    : membranes_(world),
      polygons_(world),
      wall_{.radius_mm = 0.0F,
            .inverse_mass = 0.0F,
            .inverse_inertia = 0.0F,
            .friction = walls.friction,
            .restitution = walls.restitution},
      spring_impulse_(world.joints.size()) {
    Bodies const& bodies = world.bodies;
    std::vector<float> mass;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        float const radius_mm = bodies.radius_mm[i];
        mass.push_back(bodies.spec[i].density * std::numbers::pi_v<float> * radius_mm * radius_mm);
    }
    add_mass_to_membranes(world, mass);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        BodySpec const& spec = bodies.spec[i];
        float const radius_mm = bodies.radius_mm[i];
        disks_.push_back({.radius_mm = polygons_.is_one(static_cast<std::uint32_t>(i)) ? 0.0F : radius_mm,
                          .inverse_mass = spec.fixed ? 0.0F : 1.0F / mass[i],
                          .inverse_inertia = spec.fixed ? 0.0F : 2.0F / (mass[i] * radius_mm * radius_mm),
                          .friction = spec.friction,
                          .restitution = spec.restitution});
    }
}

/// The bounding disk of a polygon may be much larger than the polygon.
void DiskContacts::add_fixed(World const& world, std::uint32_t disk, std::uint32_t fixed, float skin_mm) {
    if (!polygons_.is_one(fixed) ||
        polygons_.gap_to(world, fixed, world.bodies.position_mm[disk]).distance_mm < disks_[disk].radius_mm + skin_mm) {
        with_fixed_.push_back({.a = disk, .b = fixed, .law = law_between(disks_[disk], disks_[fixed])});
    }
}

void DiskContacts::build(World const& world, NeighbourList const& pairs, WallNeighbourList const& walls) {
    walls_ = walls.sides();
    keep_impulses();
    near_.clear();
    with_fixed_.clear();
    for (auto const [a, b] : pairs.pairs()) {
        if (!membranes_.may_collide(a, b)) {
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
        near_.push_back({.a = body, .b = edge, .law = law_between(disks_[body], wall_)});
    }
    give_impulses();
}

/// Symmetric in the two disks.
std::uint64_t DiskContacts::things_of(std::uint32_t contact) const {
    auto const [a, b, law] = near_[contact];
    constexpr std::uint64_t walls = std::uint64_t{1} << 63U;
    return contact >= first_wall_ ? walls | std::uint64_t{a} << 32U | b
                                  : std::uint64_t{std::min(a, b)} << 32U | std::max(a, b);
}

void DiskContacts::keep_impulses() {
    pushing_.clear();
    for (std::uint32_t i = 0; i < near_.size(); ++i) {
        if (driven_impulse_[i] > 0.0F) {
            pushing_.push_back({things_of(i), driven_impulse_[i]});
        }
    }
    std::ranges::sort(pushing_, {}, &Pushing::things);
}

void DiskContacts::give_impulses() {
    driven_impulse_.assign(near_.size(), 0.0F);
    for (std::uint32_t i = 0; i < near_.size() && !pushing_.empty(); ++i) {
        std::uint64_t const things = things_of(i);
        auto const known = std::ranges::lower_bound(pushing_, things, {}, &Pushing::things);
        if (known != pushing_.end() && known->things == things) {
            driven_impulse_[i] = known->impulse;
        }
    }
}

std::optional<Gap> DiskContacts::gap_to_fixed(World const& world, std::uint32_t contact, Vec2 point_mm) const {
    std::uint32_t const fixed = near_[contact].b;
    if (contact >= first_wall_) {
        return gap_to((*walls_)[fixed], point_mm);
    }
    if (polygons_.is_one(fixed)) {
        return polygons_.gap_to(world, fixed, point_mm);
    }
    return gap_to_centre(minimum_image(world, world.bodies.position_mm[fixed], point_mm));
}

}  // namespace pogosim
