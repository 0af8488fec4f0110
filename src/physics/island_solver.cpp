#include "physics/island_solver.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "physics/membrane_steps.hpp"

namespace pogosim {

namespace {

constexpr int kSubsteps = 4;
// Iterations over the contacts of an island end when none of them changes a gap at the end of the sub-step by more.
constexpr float kConvergedMm = 0.005F;
constexpr float kLinksConvergedMm = 1e-4F;  // along a chain, what is left adds up
constexpr int kMostPasses = 8;
constexpr int kMostSoftPasses = 6;      // an impulse has to travel round a membrane
constexpr int kMostRelaxingPasses = 3;  // of them: what is left is small
constexpr int kMostHullPasses = 10;     // the two touches of a contact push against each other, as links do
// Soft constraint: natural frequency relative to the rate of sub-steps, and damping ratio; see Catto, "Solver2D".
constexpr float kStiffness = 0.25F;
constexpr float kDampingRatio = 3.0F;
// A soft membrane accelerates bodies to at most this multiple of the highest speed before, and never beyond the speed
// that sub-steps can follow: a crushed membrane would explode.
constexpr float kMostThrown = 4.0F;
// In an island with membranes, a contact takes part in the iterations if its gap at the end of the sub-step would be
// smaller. The others are checked at the end: hardly any of them has to be solved.
constexpr float kCloseMm = 0.25F;
// A hull turns by at most this in a sub-step, rad, as long as there are not too many.
constexpr float kMostTurnRad = 0.1F;
// What springs swing by at most in a sub-step, rad, as long as there are not too many.
constexpr float kMostSwingRad = 0.5F;

// Links that have added more energy than this, in parts of what there was, have pushed against contacts in vain.
constexpr double kMuchEnergy = 1.01;

// Smaller islands need no initial guess of their impulses: they converge in one or two iterations.
constexpr std::uint32_t kLargeIsland = 32;

// Contacts of an island whose bodies are prefetched: more would not stay in the cache.
constexpr std::uint32_t kMostExpected = 64;

constexpr float kUnlimited = std::numeric_limits<float>::max();
constexpr std::uint32_t kMostBlocks = 64;

constexpr float push_rate(float h_s) {
    float const omega = 2.0F * std::numbers::pi_v<float> * kStiffness / h_s;
    return omega / (2.0F * kDampingRatio + h_s * omega);
}

// Nothing takes back the speed at which overlaps within the tolerance are pushed apart, so short time steps must not
// make it high: it is at most that of steps of 10 ms.
constexpr float kGentleRate = push_rate(0.01F / kSubsteps);

}  // namespace

IslandSolver::IslandSolver(World const& world)
    : movers_(1),
      membranes_(world),
      most_motion_mm_(most_motion_mm(world, std::numeric_limits<float>::max())),
      mover_(world.bodies.size()) {}

inline std::uint32_t IslandSolver::mover_of(World const& world, NearContacts const& contacts, std::uint32_t body) {
    std::uint32_t const known = mover_[body];
    if (known < movers_.size() && movers_[known].body == body) {
        return known;
    }
    auto const mover = static_cast<std::uint32_t>(movers_.size());
    Bodies const& bodies = world.bodies;
    Disk const& disk = contacts.disk(body);
    mover_[body] = mover;
    movers_.push_back({.position_mm = bodies.position_mm[body],
                       .velocity_mm_s = bodies.velocity_mm_s[body],
                       .heading_rad = bodies.heading_rad[body],
                       .angular_velocity_rad_s = bodies.angular_velocity_rad_s[body],
                       .radius_mm = disk.radius_mm,
                       .inverse_mass = disk.inverse_mass,
                       .inverse_inertia = disk.inverse_inertia,
                       .body = body});
    return mover;
}

void IslandSolver::gather(World const& world, Assemblies& assemblies, NearContacts const& contacts,
                          Islands const& islands, Island const& island) {
    block_shift_ = 0;
    while (island.contact_count > kMostBlocks << block_shift_) {
        ++block_shift_;
    }
    movers_.resize(1);
    contacts_.clear();
    pair_count_ = 0;
    membranes_.clear();
    hulls_.clear();
    links_.clear();
    for (std::uint32_t i = island.first_assembly; i != kNone; i = islands.next_assemblies()[i]) {
        Assembly const& assembly = assemblies.all()[i];
        for (std::uint32_t const body : assembly.bodies) {
            mover_of(world, contacts, body);
        }
        for (std::uint32_t const membrane : assembly.membranes) {
            membranes_.add(world, membrane, movers_, mover_[world.membranes[membrane].body], contacts.spring_impulse());
        }
        links_.add(world, assemblies, assembly, movers_, mover_);
    }
    for (std::uint32_t link = island.first; link != kNone; link = islands.contacts()[link].next) {
        std::uint32_t const index = islands.contacts()[link].contact;
        NearContact const& near = contacts.near()[index];
        bool const is_pair = contacts.is_pair(index);
        std::uint32_t const a = mover_of(world, contacts, near.a);
        std::uint32_t const b = is_pair ? mover_of(world, contacts, near.b) : kStill;
        if (index >= contacts.first_hull()) {
            hulls_.add(world, contacts, index, a, b, movers_);
            continue;
        }
        Vec2 seam_mm;
        if (is_pair) {
            ++pair_count_;
            if (world.periodic) {
                Vec2 const from_mm = movers_[b].position_mm;
                Vec2 const to_mm = movers_[a].position_mm;
                seam_mm = minimum_image(world, from_mm, to_mm) - (to_mm - from_mm);
            }
        }
        std::uint64_t const block = std::uint64_t{1} << (contacts_.size() >> block_shift_);
        movers_[a].blocks |= block;
        movers_[b].blocks |= block;
        contacts_.push_back({.a = a, .b = b, .near = index, .law = near.law, .seam_mm = seam_mm});
    }
    movers_[kStill].blocks = 0;
}

void IslandSolver::expect(World const& world, NearContacts const& contacts, Islands const& islands,
                          Island const& island) const {
    auto const expect_body = [&](std::uint32_t body) {
        Bodies const& bodies = world.bodies;
        __builtin_prefetch(&mover_[body], 1);
        __builtin_prefetch(&bodies.position_mm[body], 1);
        __builtin_prefetch(&bodies.velocity_mm_s[body], 1);
        __builtin_prefetch(&bodies.heading_rad[body], 1);
        __builtin_prefetch(&bodies.angular_velocity_rad_s[body], 1);
        __builtin_prefetch(&contacts.disk(body));
    };
    std::uint32_t link = island.first;
    for (std::uint32_t i = 0; i < kMostExpected && link != kNone; ++i) {
        IslandContact const& contact = islands.contacts()[link];
        expect_body(contacts.near()[contact.contact].a);
        if (contacts.is_pair(contact.contact)) {
            expect_body(contacts.near()[contact.contact].b);
        }
        link = contact.next;
    }
}

/// Where numbers have become too large for a float, the body stays where it was, at rest.
void IslandSolver::scatter(World& world) {
    Bodies& bodies = world.bodies;
    for (std::size_t i = 1; i < movers_.size(); ++i) {
        Mover const& mover = movers_[i];
        if (!is_finite(mover.position_mm + mover.velocity_mm_s) ||
            !std::isfinite(mover.heading_rad + mover.angular_velocity_rad_s)) {
            bodies.velocity_mm_s[mover.body] = {};
            bodies.angular_velocity_rad_s[mover.body] = 0.0F;
            links_.forget_impulses();
            continue;
        }
        bodies.position_mm[mover.body] = mover.position_mm;
        bodies.velocity_mm_s[mover.body] = mover.velocity_mm_s;
        bodies.heading_rad[mover.body] = mover.heading_rad;
        bodies.angular_velocity_rad_s[mover.body] = mover.angular_velocity_rad_s;
    }
}

/// Marks a contact as one that has to be solved.
void IslandSolver::mark(Contact& contact) {
    contact.solved = -1;
    dirty_ |= std::uint64_t{1} << (static_cast<std::size_t>(&contact - contacts_.data()) >> block_shift_);
}

void IslandSolver::mark_overlaps() {
    for (Contact& contact : contacts_) {
        if (contact.gap_mm < 0.0F) {
            mark(contact);
        }
    }
}

/// Measures the contacts at the start of a sub-step, and sets the speeds that they demand: bodies that meet within it
/// bounce at once, others may close their gap, and those that overlap are pushed apart.
IslandSolver::Survey IslandSolver::measure(World const& world, NearContacts const& contacts, Times const& times) {
    Four least_gap_mm = all_four(kUnlimited);
    FourInts meets = {};
    dirty_ = 0;
    auto const count = static_cast<std::uint32_t>(contacts_.size());
    for (std::uint32_t first = 0; first < count; first += kLanes) {
        std::span const four = std::span(contacts_).subspan(first, std::min(kLanes, count - first));
        Places const places = find_places(world, contacts, four, first);
        Four const speed_mm_s = places.speed_mm_s;
        Four const gap_mm = places.gap_mm;
        Four const bouncing_mm_s =
            smaller(-places.restitution * speed_mm_s, larger(-speed_mm_s, all_four(kMostBounceMmS)));
        Four const meeting_mm_s = -gap_mm * times.per_h;
        Four const push_rate = gap_mm < -kContactToleranceMm ? all_four(times.push_rate)
                                                             : all_four(std::min(times.push_rate, kGentleRate));
        Four const pushed_mm_s = smaller(-push_rate * gap_mm, all_four(kFastestPushMmS));
        FourInts const is_elastic = places.restitution > 0.0F;
        FourInts const is_free = gap_mm > 0.0F;
        FourInts const bounces =
            (speed_mm_s < -kRestitutionThresholdMmS) & is_elastic & (gap_mm + speed_mm_s * times.h_s <= 0.0F);
        Four const least_mm_s = bounces ? bouncing_mm_s : is_free ? meeting_mm_s : pushed_mm_s;
        Four const relaxed_mm_s = bounces ? bouncing_mm_s : is_free ? meeting_mm_s : Four{};
        // A body that is thrown against another one in this sub-step bounces in the next one, unless it would be deep
        // in the other body by then.
        Four const late_mm_s = -(gap_mm + kMostLateMm) * times.per_h;
        Four const latest_mm_s = (is_elastic & is_free & ~bounces) ? late_mm_s : all_four(kUnlimited);
        FourInts const demands = speed_mm_s < least_mm_s;
        least_gap_mm = smaller(least_gap_mm, gap_mm);
        meets |= gap_mm + kContactToleranceMm < -speed_mm_s * times.rest_s;
        for (std::uint32_t i = 0; i < four.size(); ++i) {
            Contact& contact = four[i];
            contact.normal = {places.normal_x[i], places.normal_y[i]};
            contact.gap_mm = gap_mm[i];
            contact.least_mm_s = least_mm_s[i];
            contact.relaxed_mm_s = relaxed_mm_s[i];
            contact.latest_mm_s = latest_mm_s[i];
            contact.normal_impulse = contact.tangent_impulse = 0.0F;
            contact.solved = demands[i];
            dirty_ |= static_cast<std::uint64_t>(-demands[i]) << ((first + i) >> block_shift_);
        }
    }
    return {.overlaps = is_any(least_gap_mm < -kContactToleranceMm), .meets = is_any(meets)};
}

/// Places of up to four contacts, the first of which has the index `first`. Unused lanes have a large gap.
inline IslandSolver::Places IslandSolver::find_places(World const& world, NearContacts const& contacts,
                                                      std::span<Contact const> four, std::uint32_t first) const {
    std::array<Four, kLanes> motion;
    Places places = {};
    Four radius_mm = {};
    for (std::uint32_t i = 0; i < kLanes; ++i) {
        Contact const& contact = four[std::min<std::size_t>(i, four.size() - 1)];
        Mover const& a = movers_[contact.a];
        Mover const& b = movers_[contact.b];
        motion[i] = Four{a.position_mm.x, a.position_mm.y, a.velocity_mm_s.x, a.velocity_mm_s.y} -
                    Four{b.position_mm.x, b.position_mm.y, b.velocity_mm_s.x, b.velocity_mm_s.y} +
                    Four{contact.seam_mm.x, contact.seam_mm.y, 0.0F, 0.0F};
        radius_mm[i] = contact.law.radius_mm;
        places.restitution[i] = contact.law.restitution;
    }
    auto const [x_mm, y_mm, velocity_x_mm_s, velocity_y_mm_s] =
        transposed({motion[0], motion[1], motion[2], motion[3]});
    Four const distance_mm = square_root(x_mm * x_mm + y_mm * y_mm);
    FourInts const is_apart = distance_mm > 0.0F;  // coinciding centres are separated along x
    Four const per_mm = 1.0F / distance_mm;
    places.normal_x = is_apart ? per_mm * x_mm : all_four(1.0F);
    places.normal_y = is_apart ? per_mm * y_mm : Four{};
    places.gap_mm = distance_mm - radius_mm;
    for (std::uint32_t i = pair_count_ - std::min(first, pair_count_); i < four.size(); ++i) {
        Contact const& contact = four[i];
        std::optional<Gap> const gap = contacts.gap_to_fixed(world, contact.near, movers_[contact.a].position_mm);
        // None: the disk faces another edge of the wall.
        places.normal_x[i] = gap ? gap->normal.x : 0.0F;
        places.normal_y[i] = gap ? gap->normal.y : 0.0F;
        places.gap_mm[i] = gap ? gap->distance_mm - contact.law.radius_mm : kUnlimited;
    }
    for (auto i = static_cast<std::uint32_t>(four.size()); i < kLanes; ++i) {
        places.gap_mm[i] = kUnlimited;
    }
    places.speed_mm_s = velocity_x_mm_s * places.normal_x + velocity_y_mm_s * places.normal_y;
    return places;
}

/// Returns the change of the speed of separation.
float IslandSolver::solve_contact(Contact& contact, float demanded_mm_s) {
    Mover& a = movers_[contact.a];
    Mover& b = movers_[contact.b];
    Vec2 const normal = contact.normal;
    Vec2 const velocity = a.velocity_mm_s - b.velocity_mm_s;
    float const speed_mm_s = dot(velocity, normal);
    float const normal_before = contact.normal_impulse;
    if (normal_before == 0.0F && speed_mm_s >= demanded_mm_s) {
        return 0.0F;  // most contacts are close but do not touch
    }
    bool const waits = speed_mm_s > contact.latest_mm_s && speed_mm_s < -kRestitutionThresholdMmS;
    float const change_mm_s = waits ? 0.0F : demanded_mm_s - speed_mm_s;
    contact.normal_impulse = std::max(normal_before + contact.law.normal_mass * change_mm_s, 0.0F);
    float const push = contact.normal_impulse - normal_before;
    if (push == 0.0F && contact.normal_impulse == 0.0F) {
        return 0.0F;
    }

    // Coulomb friction turns the disks. The tangent is clockwise of the normal.
    Vec2 const tangent{-normal.y, normal.x};
    float const slip_mm_s =
        dot(velocity, tangent) - a.radius_mm * a.angular_velocity_rad_s - b.radius_mm * b.angular_velocity_rad_s;
    float const most = contact.law.friction * contact.normal_impulse;
    float const tangent_before = contact.tangent_impulse;
    contact.tangent_impulse = std::clamp(tangent_before - contact.law.tangent_mass * slip_mm_s, -most, most);
    float const rub = contact.tangent_impulse - tangent_before;

    Vec2 const impulse = push * normal + rub * tangent;
    a.velocity_mm_s = a.velocity_mm_s + a.inverse_mass * impulse;
    b.velocity_mm_s = b.velocity_mm_s - b.inverse_mass * impulse;
    a.angular_velocity_rad_s -= a.inverse_inertia * a.radius_mm * rub;
    b.angular_velocity_rad_s -= b.inverse_inertia * b.radius_mm * rub;
    return std::abs(push) * contact.law.inverse_normal_mass;
}

/// `clean_block`: the bit of the contact's block if no other contact of that block is dirty.
void IslandSolver::solve_if_changed(Contact& contact, std::uint64_t clean_block, float h_s, bool pushes) {
    Mover& a = movers_[contact.a];
    Mover& b = movers_[contact.b];
    if (std::max(a.changed, b.changed) <= contact.solved) {
        return;
    }
    contact.solved = ++clock_;
    if (h_s * solve_contact(contact, pushes ? contact.least_mm_s : contact.relaxed_mm_s) > kConvergedMm) {
        a.changed = clock_;
        b.changed = contact.b != kStill ? clock_ : 0;
        dirty_ |= (a.blocks | b.blocks) & ~clean_block;
    }
}

/// Forwards and backwards in turn: contacts are ordered by place, walls last, so that the resistance of a wall reaches
/// the whole crowd in front of it.
void IslandSolver::solve_velocities(float h_s, bool pushes) {
    for (int pass = 0; pass < kMostPasses && dirty_ != 0; ++pass) {
        bool const backwards = pass % 2 == 0;
        for (std::uint64_t due = dirty_; due != 0;) {
            auto const block = static_cast<std::uint32_t>(backwards ? std::bit_width(due) - 1 : std::countr_zero(due));
            solve_block(block, backwards, h_s, pushes);
            std::uint64_t const bit = std::uint64_t{1} << block;
            due = dirty_ & (backwards ? bit - 1 : -bit << 1U);
        }
    }
}

/// A block of several contacts stays dirty if others in it are.
void IslandSolver::solve_block(std::uint32_t block, bool backwards, float h_s, bool pushes) {
    std::uint64_t const bit = std::uint64_t{1} << block;
    std::uint64_t const clean = block_shift_ == 0 ? bit : 0;
    auto const count = static_cast<std::uint32_t>(contacts_.size());
    std::uint32_t const first = block << block_shift_;
    std::uint32_t const last = std::min(first + (1U << block_shift_), count);
    dirty_ &= ~bit;
    for (std::uint32_t i = 0; i < last - first; ++i) {
        solve_if_changed(contacts_[backwards ? last - 1 - i : first + i], clean, h_s, pushes);
    }
}

void IslandSolver::move(float time_s) {
    for (Mover& mover : movers_) {
        mover.position_mm = mover.position_mm + time_s * mover.velocity_mm_s;
        mover.heading_rad += time_s * mover.angular_velocity_rad_s;
    }
}

/// Number of sub-steps before the first impact, if no velocity has to change before.
int IslandSolver::substeps_to_impact(Times const& times) const {
    float earliest_s = times.rest_s;
    for (Contact const& contact : contacts_) {
        float const speed_mm_s =
            dot(movers_[contact.a].velocity_mm_s - movers_[contact.b].velocity_mm_s, contact.normal);
        if (speed_mm_s < 0.0F && contact.gap_mm < -speed_mm_s * earliest_s) {
            earliest_s = contact.gap_mm / -speed_mm_s;
        }
    }
    return std::max(static_cast<int>(earliest_s * times.per_h), 1);
}

/// Warm starting. The iterations correct what has changed since.
void IslandSolver::push_as_before(std::vector<float> const& driven_impulse) {
    for (Contact& contact : contacts_) {
        mark(contact);
        contact.normal_impulse = driven_impulse[contact.near];
        Mover& a = movers_[contact.a];
        Mover& b = movers_[contact.b];
        Vec2 const impulse = contact.normal_impulse * contact.normal;
        a.velocity_mm_s = a.velocity_mm_s + a.inverse_mass * impulse;
        b.velocity_mm_s = b.velocity_mm_s - b.inverse_mass * impulse;
    }
}

void IslandSolver::keep_impulses(std::vector<float>& driven_impulse) const {
    for (Contact const& contact : contacts_) {
        driven_impulse[contact.near] = contact.normal_impulse;
    }
}

/// Times two.
double IslandSolver::kinetic_energy(Vec2 drift_mm_s) const {
    double energy = 0.0;
    for (Mover const& mover : movers_) {
        if (mover.inverse_mass > 0.0F) {
            float const spin_rad_s = mover.angular_velocity_rad_s;
            energy += static_cast<double>(squared_length(mover.velocity_mm_s - drift_mm_s) / mover.inverse_mass) +
                      static_cast<double>(spin_rad_s * spin_rad_s / mover.inverse_inertia);
        }
    }
    return energy;
}

/// The velocity of the centre of mass.
Vec2 IslandSolver::drift_mm_s() const {
    Vec2 sum;
    float mass = 0.0F;
    for (Mover const& mover : movers_) {
        if (mover.inverse_mass > 0.0F) {
            sum = sum + (1.0F / mover.inverse_mass) * mover.velocity_mm_s;
            mass += 1.0F / mover.inverse_mass;
        }
    }
    return (1.0F / mass) * sum;
}

/// Takes back the energy that links and contacts have added which push against each other in vain, as in a chain that
/// is tied into a knot. Returns whether it was much.
bool IslandSolver::limit_energy(double most) {
    Vec2 const drift = drift_mm_s();
    double const inner = kinetic_energy(drift);
    double const outer = kinetic_energy({}) - inner;
    if (outer + inner <= most || inner == 0.0) {
        return false;
    }
    auto const share = static_cast<float>(std::sqrt(std::max(most - outer, 0.0) / inner));
    for (Mover& mover : std::span(movers_).subspan(1)) {
        mover.velocity_mm_s = drift + share * (mover.velocity_mm_s - drift);
        mover.angular_velocity_rad_s *= share;
    }
    return outer + inner > kMuchEnergy * most;
}

/// With turning that matters, the speed of a corner.
float IslandSolver::fastest_mm_s() const {
    float const turn = turns_matter() ? 1.0F : 0.0F;
    float fastest_mm_s = 0.0F;
    for (Mover const& mover : movers_) {
        fastest_mm_s = std::max(fastest_mm_s, length(mover.velocity_mm_s) +
                                                  turn * std::abs(mover.angular_velocity_rad_s) * mover.radius_mm);
    }
    return fastest_mm_s;
}

float IslandSolver::fastest_turn_rad_s() const {
    if (!turns_matter()) {
        return 0.0F;
    }
    float fastest_rad_s = 0.0F;
    for (Mover const& mover : movers_) {
        fastest_rad_s = std::max(fastest_rad_s, std::abs(mover.angular_velocity_rad_s));
    }
    return fastest_rad_s;
}

/// Returns whether any body was faster.
bool IslandSolver::limit_speeds(float most_mm_s, float most_rad_s) {
    bool is_limited = false;
    for (Mover& mover : movers_) {
        if (std::abs(mover.angular_velocity_rad_s) > most_rad_s) {
            mover.angular_velocity_rad_s = std::clamp(mover.angular_velocity_rad_s, -most_rad_s, most_rad_s);
            is_limited = true;
        }
        float const speed_mm_s = length(mover.velocity_mm_s);
        if (speed_mm_s > most_mm_s) {
            mover.velocity_mm_s = (most_mm_s / speed_mm_s) * mover.velocity_mm_s;
            is_limited = true;
        }
    }
    return is_limited;
}

/// `now`: on the clock of the movers.
void IslandSolver::find_close_contacts(float per_h, std::int32_t now) {
    close_.clear();
    far_.clear();
    for (std::uint32_t i = 0; i < contacts_.size(); ++i) {
        Contact const& contact = contacts_[i];
        Mover& a = movers_[contact.a];
        Mover& b = movers_[contact.b];
        float const speed_mm_s = dot(a.velocity_mm_s - b.velocity_mm_s, contact.normal);
        if (membranes_.empty() || speed_mm_s - contact.least_mm_s < kCloseMm * per_h) {
            close_.push_back(i);
            a.changed = b.changed = now;
        } else {
            far_.push_back(i);
        }
    }
}

/// Springs and links before contacts: contacts, which must hold, are solved last.
void IslandSolver::solve_velocities_softly(float h_s, bool pushes) {
    int const soft_passes = pushes ? kMostSoftPasses : kMostRelaxingPasses;
    int const passes = hulls_.empty() && links_.empty() ? soft_passes : kMostHullPasses;
    float links_change_mm_s = 0.0F;
    bool are_links_solved = links_.empty();
    membranes_.begin_iterations(movers_);
    for (int pass = 0; pass < passes; ++pass) {
        bool const backwards = pass % 2 == 0;
        float change_mm_s = membranes_.solve(movers_, backwards, !pushes);
        if (!are_links_solved) {
            links_change_mm_s = links_.solve(movers_, backwards, pushes);
            // What contacts change later changes the damping of springs by a thousandth of it.
            are_links_solved = !links_.has_rigid() && h_s * links_change_mm_s <= kLinksConvergedMm;
        }
        for (std::size_t i = 0; i < close_.size(); ++i) {
            Contact& contact = contacts_[close_[backwards ? close_.size() - 1 - i : i]];
            change_mm_s = std::max(change_mm_s, solve_contact(contact, contact.demanded_mm_s(pushes)));
        }
        change_mm_s = std::max(change_mm_s, hulls_.solve(movers_, backwards, pushes));
        if (h_s * change_mm_s <= kConvergedMm && h_s * links_change_mm_s <= kLinksConvergedMm) {
            break;
        }
    }
    membranes_.end_iterations(movers_);
    for (std::uint32_t const far : far_) {
        solve_contact(contacts_[far], contacts_[far].demanded_mm_s(pushes));
    }
}

/// No body moves further in a sub-step than membranes can hold back, see membrane_steps.hpp.
int IslandSolver::substeps_of(float dt_s) const {
    float const needed =
        std::ceil(std::max({fastest_mm_s() * dt_s / most_motion_mm_, fastest_turn_rad_s() * dt_s / kMostTurnRad,
                            links_.fastest_turn_rad_s(movers_) * dt_s / kMostTurnRad,
                            links_.fastest_swing_rad_s() * dt_s / kMostSwingRad}));
    return static_cast<int>(std::clamp(needed, static_cast<float>(kSubsteps), static_cast<float>(kMostSubsteps)));
}

/// Returns whether some bodies overlap in the end.
bool IslandSolver::solve_soft(World const& world, NearContacts& contacts, bool is_driven) {
    auto const dt_s = static_cast<float>(world.time_step_s);
    int const substeps = substeps_of(dt_s);
    // Springs of links may throw as far as they can.
    float const most_mm_s = membranes_.empty() && !links_.empty()
                                ? kUnlimited
                                : std::min(kMostThrown * std::max(fastest_mm_s(), kFastestPushMmS),
                                           static_cast<float>(kMostSubsteps) * most_motion_mm_ / dt_s);
    float const most_rad_s = turns_matter() ? static_cast<float>(kMostSubsteps) * kMostTurnRad / dt_s : kUnlimited;
    // Once springs have pulled, only walls with a restitution above 1 can add energy.
    bool const keeps_energy =
        links_.has_rigid() && membranes_.empty() &&
        std::ranges::all_of(contacts_, [](Contact const& contact) { return contact.law.restitution <= 1.0F; });
    float const h_s = dt_s / static_cast<float>(substeps);
    Times times{.h_s = h_s, .rest_s = 0.0F, .per_h = 1.0F / h_s, .push_rate = push_rate(h_s)};
    bool overlaps = false;
    for (int substep = 0; substep < substeps; ++substep) {
        times.rest_s = static_cast<float>(substeps - substep) * h_s;
        bool const is_too_long = membranes_.begin_substep(movers_, h_s, times.push_rate);
        links_.begin_substep(movers_, times);
        double const most_energy = keeps_energy ? kinetic_energy({}) : 0.0;
        links_.push_as_before(movers_);
        overlaps = measure(world, contacts, times).overlaps;
        overlaps = hulls_.measure(contacts, movers_, times) || overlaps;
        find_close_contacts(times.per_h, substep + 1);
        membranes_.note_pushed(movers_, substep + 1, /*all=*/!hulls_.empty() || !links_.empty());
        if (is_driven && substep == 0) {
            hulls_.push_as_before(contacts, movers_);
        }
        solve_velocities_softly(h_s, /*pushes=*/true);
        if (is_driven && substep == 0) {
            hulls_.keep_impulses(contacts);
        }
        bool const is_limited = limit_speeds(most_mm_s, most_rad_s);
        move(h_s);
        if (is_limited) {
            membranes_.forget_impulses();  // bad initial guesses would grow with each sub-step
            links_.forget_impulses();
        } else if (overlaps || is_too_long || links_.has_rigid()) {
            links_.begin_relaxing(movers_);
            solve_velocities_softly(h_s, /*pushes=*/false);
        }
        bool const has_added = keeps_energy && limit_energy(most_energy);
        links_.end_substep();
        if (has_added) {
            links_.forget_impulses();
        }
    }
    return overlaps;
}

bool IslandSolver::solve(World& world, Assemblies& assemblies, NearContacts& contacts, Islands const& islands,
                         Island const& island, bool is_driven) {
    gather(world, assemblies, contacts, islands, island);
    if (!membranes_.empty() || !hulls_.empty() || !links_.empty()) {
        bool const overlaps = solve_soft(world, contacts, is_driven);
        membranes_.keep_impulses(contacts.spring_impulse());
        links_.write_tensions(world);
        scatter(world);
        return overlaps;
    }
    float const h_s = static_cast<float>(world.time_step_s) / kSubsteps;
    Times times{.h_s = h_s, .rest_s = 0.0F, .per_h = 1.0F / h_s, .push_rate = push_rate(h_s)};
    bool overlaps = false;
    for (int substep = 0; substep < kSubsteps;) {
        times.rest_s = static_cast<float>(kSubsteps - substep) * h_s;
        Survey const survey = measure(world, contacts, times);
        if (!survey.overlaps && !survey.meets) {
            move(times.rest_s);
            break;
        }
        if (dirty_ == 0) {
            int const free = std::min(substeps_to_impact(times), kSubsteps - substep);
            move(static_cast<float>(free) * h_s);
            substep += free;
            continue;
        }
        clock_ = 0;
        for (Mover& mover : movers_) {
            mover.changed = 0;
        }
        bool const has_guess = is_driven && substep == 0 && island.contact_count >= kLargeIsland;
        if (has_guess) {
            push_as_before(contacts.driven_impulse());
        }
        solve_velocities(h_s, /*pushes=*/true);
        if (has_guess) {
            keep_impulses(contacts.driven_impulse());
        }
        move(h_s);
        if (survey.overlaps) {
            mark_overlaps();
            solve_velocities(h_s, /*pushes=*/false);
            overlaps = overlaps || substep + 1 == kSubsteps;
        }
        ++substep;
    }
    scatter(world);
    return overlaps;
}

}  // namespace pogosim
