#include "physics/disk_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace pogosim {

namespace {

constexpr int kSubsteps = 4;
// Passes through the contacts of an island end when none of them changes a gap at the end of the sub-step by more.
constexpr float kConvergedMm = 0.005F;
constexpr int kMostPasses = 32;
// Slower impacts are inelastic.
constexpr float kRestitutionThresholdMmS = 5.0F;
// Soft constraint: natural frequency in parts of the rate of sub-steps, and damping ratio, see Catto, "Solver2D".
constexpr float kStiffness = 0.25F;
constexpr float kDampingRatio = 3.0F;
constexpr float kFastestPushMmS = 500.0F;
// Impacts may be this late.
constexpr float kMostLateMm = 0.5F;
// Smaller overlaps may stay.
constexpr float kToleranceMm = 0.05F;

/// Speed, per mm of overlap, with which a soft constraint pushes, 1/s.
float push_rate(float h_s) {
    float const omega = 2.0F * std::numbers::pi_v<float> * kStiffness / h_s;
    return omega / (2.0F * kDampingRatio + h_s * omega);
}

}  // namespace

DiskSolver::DiskSolver(World const& world, WallSpec const& walls) : wall_(walls) {
    Bodies const& bodies = world.bodies;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        BodySpec const& spec = bodies.spec[i];
        float const radius_mm = bodies.radius_mm[i];
        float const mass = spec.density * std::numbers::pi_v<float> * radius_mm * radius_mm;
        disks_.push_back({.radius_mm = radius_mm,
                          .inverse_mass = spec.fixed ? 0.0F : 1.0F / mass,
                          .inverse_inertia = spec.fixed ? 0.0F : 2.0F / (mass * radius_mm * radius_mm),
                          .friction = spec.friction,
                          .restitution = spec.restitution});
    }
    has_contact_.assign(bodies.size(), 0);
    parent_.resize(bodies.size());
    changed_.resize(bodies.size());
    island_.resize(bodies.size());
}

void DiskSolver::touch(std::uint32_t body) {
    if (has_contact_[body] == 0) {
        has_contact_[body] = 1;
        parent_[body] = body;
        found_bodies_.push_back(body);
    }
}

std::uint32_t DiskSolver::root_of(std::uint32_t body) {
    while (parent_[body] != body) {
        body = parent_[body] = parent_[parent_[body]];
    }
    return body;
}

void DiskSolver::add_pair(World const& world, NearPair const& pair, float reach_mm) {
    Disk const& a = disks_[pair.a];
    Disk const& b = disks_[pair.b];
    std::vector<Vec2> const& position_mm = world.bodies.position_mm;
    float const radius_mm = a.radius_mm + b.radius_mm;
    float const far_mm = radius_mm + reach_mm;
    if (squared_length(minimum_image(world, position_mm[pair.a], position_mm[pair.b])) >= far_mm * far_mm) {
        return;
    }
    float const inverse_mass = a.inverse_mass + b.inverse_mass;
    float const inverse_tangent_mass =
        inverse_mass + a.radius_mm * a.radius_mm * a.inverse_inertia + b.radius_mm * b.radius_mm * b.inverse_inertia;
    found_.push_back({.a = pair.a,
                      .b = pair.b,
                      .edge = kNone,
                      .radius_mm = radius_mm,
                      .normal_mass = 1.0F / inverse_mass,
                      .tangent_mass = 1.0F / inverse_tangent_mass,
                      .friction = std::sqrt(a.friction * b.friction),
                      .restitution = std::max(a.restitution, b.restitution)});
    // Fixed bodies do not connect those that touch them.
    if (a.inverse_mass > 0.0F) {
        touch(pair.a);
    }
    if (b.inverse_mass > 0.0F) {
        touch(pair.b);
    }
    if (a.inverse_mass > 0.0F && b.inverse_mass > 0.0F) {
        std::uint32_t const root_a = root_of(pair.a);
        std::uint32_t const root_b = root_of(pair.b);
        parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
    }
}

void DiskSolver::add_wall(World const& world, NearWalls const& walls, NearWall const& wall, float reach_mm) {
    Disk const& a = disks_[wall.body];
    std::optional<WallGap> const gap = gap_to(walls.side(wall.edge), world.bodies.position_mm[wall.body]);
    if (!gap || gap->distance_mm - a.radius_mm >= reach_mm) {
        return;
    }
    found_.push_back({.a = wall.body,
                      .b = kNone,
                      .edge = wall.edge,
                      .radius_mm = a.radius_mm,
                      .normal_mass = 1.0F / a.inverse_mass,
                      .tangent_mass = 1.0F / (a.inverse_mass + a.radius_mm * a.radius_mm * a.inverse_inertia),
                      .friction = std::sqrt(a.friction * wall_.friction),
                      .restitution = std::max(a.restitution, wall_.restitution)});
    touch(wall.body);
}

void DiskSolver::find_contacts(World const& world, NearPairs const& pairs, NearWalls const& walls, float reach_mm) {
    for (std::uint32_t const body : touched_) {
        has_contact_[body] = 0;
    }
    found_.clear();
    found_bodies_.clear();
    for (NearPair const& pair : pairs.pairs()) {
        add_pair(world, pair, reach_mm);
    }
    for (NearWall const& wall : walls.walls()) {
        add_wall(world, walls, wall, reach_mm);
    }
    sort_into_islands();
}

/// Counting sort by island. Islands are in the order of their first bodies.
void DiskSolver::sort_into_islands() {
    islands_.clear();
    for (std::uint32_t const body : found_bodies_) {
        std::uint32_t const root = root_of(body);
        parent_[body] = root;
        if (root == body) {
            island_[root] = static_cast<std::uint32_t>(islands_.size());
            islands_.push_back({});
        }
    }
    auto const island_of = [this](std::uint32_t body) -> Island& { return islands_[island_[parent_[body]]]; };
    auto const body_of = [this](Contact const& contact) {
        return disks_[contact.a].inverse_mass > 0.0F ? contact.a : contact.b;
    };
    for (std::uint32_t const body : found_bodies_) {
        ++island_of(body).last_body;
    }
    for (Contact const& contact : found_) {
        ++island_of(body_of(contact)).last_contact;
    }
    std::uint32_t bodies = 0;
    std::uint32_t contacts = 0;
    for (Island& island : islands_) {
        bodies += island.last_body;
        contacts += island.last_contact;
        island.first_body = island.last_body = bodies - island.last_body;
        island.first_contact = island.last_contact = contacts - island.last_contact;
    }
    touched_.resize(found_bodies_.size());
    for (std::uint32_t const body : found_bodies_) {
        touched_[island_of(body).last_body++] = body;
    }
    contacts_.resize(found_.size());
    for (Contact const& contact : found_) {
        contacts_[island_of(body_of(contact)).last_contact++] = contact;
    }
}

/// Where a contact is, and the start of a sub-step: bodies that meet within it bounce at once.
void DiskSolver::measure(World const& world, NearWalls const& walls, Contact& contact, float h_s) const {
    Bodies const& bodies = world.bodies;
    Vec2 const place_mm = bodies.position_mm[contact.a];
    Vec2 velocity = bodies.velocity_mm_s[contact.a];
    contact.speed_mm_s = contact.bounce_mm_s = contact.normal_impulse = contact.tangent_impulse = 0.0F;
    if (contact.is_wall()) {
        std::optional<WallGap> const gap = gap_to(walls.side(contact.edge), place_mm);
        if (!gap) {  // the disk is before another edge of the wall
            contact.gap_mm = std::numeric_limits<float>::max();
            return;
        }
        contact.normal = gap->normal;
        contact.gap_mm = gap->distance_mm - contact.radius_mm;
    } else {
        Vec2 const way = minimum_image(world, bodies.position_mm[contact.b], place_mm);
        float const far = length(way);
        contact.normal = far > 0.0F ? (1.0F / far) * way : Vec2{1.0F, 0.0F};
        contact.gap_mm = far - contact.radius_mm;
        velocity = velocity - bodies.velocity_mm_s[contact.b];
    }
    contact.speed_mm_s = dot(velocity, contact.normal);
    bool const bounces =
        contact.speed_mm_s < -kRestitutionThresholdMmS && contact.gap_mm + contact.speed_mm_s * h_s <= 0.0F;
    contact.bounce_mm_s = bounces ? -contact.restitution * contact.speed_mm_s : 0.0F;
}

namespace {

/// The speed of separation that a contact without an impact demands at least.
float least_speed(float gap_mm, float speed_mm_s, float restitution, float h_s, bool pushes) {
    if (gap_mm > 0.0F) {
        // Who was thrown here in this sub-step bounces in the next one, unless that were deep in the other body.
        bool const bounces_later =
            speed_mm_s < -kRestitutionThresholdMmS && restitution > 0.0F && gap_mm + speed_mm_s * h_s > -kMostLateMm;
        return bounces_later ? speed_mm_s : -gap_mm / h_s;
    }
    return pushes ? std::min(-push_rate(h_s) * gap_mm, kFastestPushMmS) : 0.0F;
}

}  // namespace

/// Returns the change of the speed of separation.
float DiskSolver::solve_contact(Bodies& bodies, Contact& contact, float h_s, bool pushes) const {
    Disk const& a = disks_[contact.a];
    Disk const* const b = contact.is_wall() ? nullptr : &disks_[contact.b];
    Vec2& velocity_a = bodies.velocity_mm_s[contact.a];
    Vec2 const normal = contact.normal;
    Vec2 velocity = b != nullptr ? velocity_a - bodies.velocity_mm_s[contact.b] : velocity_a;
    float const speed_mm_s = dot(velocity, normal);
    float const target_mm_s = contact.bounce_mm_s > 0.0F
                                  ? contact.bounce_mm_s
                                  : least_speed(contact.gap_mm, speed_mm_s, contact.restitution, h_s, pushes);
    float const normal_before = contact.normal_impulse;
    contact.normal_impulse = std::max(normal_before + contact.normal_mass * (target_mm_s - speed_mm_s), 0.0F);
    float const push = contact.normal_impulse - normal_before;
    if (push == 0.0F && contact.normal_impulse == 0.0F) {
        return 0.0F;
    }
    velocity = velocity + (push / contact.normal_mass) * normal;

    // Coulomb friction turns the disks. The tangent is clockwise of the normal.
    Vec2 const tangent{-normal.y, normal.x};
    float const slip_mm_s = dot(velocity, tangent) - a.radius_mm * bodies.angular_velocity_rad_s[contact.a] -
                            (b != nullptr ? b->radius_mm * bodies.angular_velocity_rad_s[contact.b] : 0.0F);
    float const most = contact.friction * contact.normal_impulse;
    float const tangent_before = contact.tangent_impulse;
    contact.tangent_impulse = std::clamp(tangent_before - contact.tangent_mass * slip_mm_s, -most, most);
    float const rub = contact.tangent_impulse - tangent_before;

    Vec2 const impulse = push * normal + rub * tangent;
    velocity_a = velocity_a + a.inverse_mass * impulse;
    bodies.angular_velocity_rad_s[contact.a] -= a.inverse_inertia * a.radius_mm * rub;
    if (b != nullptr) {
        bodies.velocity_mm_s[contact.b] = bodies.velocity_mm_s[contact.b] - b->inverse_mass * impulse;
        bodies.angular_velocity_rad_s[contact.b] -= b->inverse_inertia * b->radius_mm * rub;
    }
    return std::abs(push) / contact.normal_mass;
}

/// Each contact until it has found its bodies unchanged. In both directions by turns: contacts are in the order of
/// their places, walls last, so that the resistance of a wall reaches the crowd before it.
void DiskSolver::solve_velocities(Bodies& bodies, std::span<Contact> contacts, float h_s, bool pushes) {
    for (int pass = 0; pass < kMostPasses; ++pass) {
        bool has_changed = false;
        auto const solve = [&](Contact& contact) {
            std::uint64_t const changed = std::max(changed_[contact.a], contact.is_wall() ? 0 : changed_[contact.b]);
            if (changed <= contact.solved) {
                return;
            }
            contact.solved = ++clock_;
            if (h_s * solve_contact(bodies, contact, h_s, pushes) > kConvergedMm) {
                has_changed = true;
                changed_[contact.a] = clock_;
                if (!contact.is_wall()) {
                    changed_[contact.b] = clock_;
                }
            }
        };
        if (pass % 2 == 0) {
            std::for_each(contacts.rbegin(), contacts.rend(), solve);
        } else {
            std::for_each(contacts.begin(), contacts.end(), solve);
        }
        if (!has_changed) {
            return;
        }
    }
}

void DiskSolver::changed_now(Island const& island) {
    ++clock_;
    for (std::uint32_t i = island.first_body; i < island.last_body; ++i) {
        changed_[touched_[i]] = clock_;
    }
}

void DiskSolver::solve_island(World& world, NearWalls const& walls, Island const& island, float dt_s) {
    Bodies& bodies = world.bodies;
    std::span const contacts(&contacts_[island.first_contact], island.last_contact - island.first_contact);
    auto const move = [&](float time_s) {
        for (std::uint32_t i = island.first_body; i < island.last_body; ++i) {
            std::uint32_t const body = touched_[i];
            bodies.position_mm[body] = bodies.position_mm[body] + time_s * bodies.velocity_mm_s[body];
            bodies.heading_rad[body] += time_s * bodies.angular_velocity_rad_s[body];
        }
    };
    float const h_s = dt_s / kSubsteps;
    for (int substep = 0; substep < kSubsteps; ++substep) {
        float const rest_s = static_cast<float>(kSubsteps - substep) * h_s;
        bool overlaps = false;
        bool meets = false;  // before the end of the step, if nobody turns
        for (Contact& contact : contacts) {
            measure(world, walls, contact, h_s);
            overlaps = overlaps || contact.gap_mm < -kToleranceMm;
            meets = meets || contact.gap_mm + kToleranceMm < -contact.speed_mm_s * rest_s;
        }
        if (!overlaps && !meets) {
            move(rest_s);
            return;
        }
        changed_now(island);
        solve_velocities(bodies, contacts, h_s, /*pushes=*/true);
        move(h_s);
        if (overlaps) {
            for (Contact& contact : contacts) {
                contact.solved = contact.gap_mm < 0.0F ? 0 : contact.solved;
            }
            solve_velocities(bodies, contacts, h_s, /*pushes=*/false);
            has_overlaps_ = has_overlaps_ || substep + 1 == kSubsteps;
        }
    }
}

void DiskSolver::solve(World& world, NearWalls const& walls) {
    has_overlaps_ = false;
    for (Island const& island : islands_) {
        solve_island(world, walls, island, static_cast<float>(world.time_step_s));
    }
}

}  // namespace pogosim
