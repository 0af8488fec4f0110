#include "physics/springs_and_rods.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/body_mass.hpp"

namespace pogosim {

namespace {

constexpr float kRigid = std::numeric_limits<float>::infinity();
// A spring that swings by more than this in a sub-step, rad, pulls as at its end. Symplectic Euler is stable below 2.
constexpr float kMostSwingRad = 1.0F;
// Shorter rods count as this long when it comes to how fast they turn.
constexpr float kShortestMm = 0.1F;

}  // namespace

bool SpringsAndRods::Held::is_rod() const {
    return stiffness == kRigid;
}

void SpringsAndRods::clear() {
    links_.clear();
    stiffness_of_mover_.clear();
    has_rods_ = false;
}

void SpringsAndRods::add(Link const& link, LinkEnds const& ends, HeldImpulse& held, std::span<Mover const> movers) {
    bool const is_rod = link.kind == LinkKind::rod;
    links_.push_back({.ends = ends,
                      .length_mm = link.length_mm,
                      .stiffness = is_rod ? kRigid : kMassPerKg * link.stiffness_n_m,
                      .damping = is_rod ? 0.0F : kMassPerKg * link.damping_n_s_m,
                      .held = &held});
    has_rods_ = has_rods_ || is_rod;
    if (is_rod) {
        return;
    }
    stiffness_of_mover_.resize(movers.size());
    for (auto const& [mover, own_mm] : {std::pair(ends.a, ends.own_a_mm), std::pair(ends.b, ends.own_b_mm)}) {
        Mover const& body = movers[mover];
        float const per_mass = body.inverse_mass + body.inverse_inertia * squared_length(own_mm);
        stiffness_of_mover_[mover] += links_.back().stiffness * per_mass;
    }
}

float SpringsAndRods::fastest_turn_rad_s(std::span<Mover const> movers) const {
    float fastest_rad_s = 0.0F;
    for (Held const& link : links_) {
        if (link.is_rod()) {
            float const speed_mm_s = length(link.ends.parting_mm_s(movers));
            fastest_rad_s = std::max(fastest_rad_s, speed_mm_s / std::max(link.length_mm, kShortestMm));
        }
    }
    return fastest_rad_s;
}

float SpringsAndRods::fastest_swing_rad_s() const {
    return stiffness_of_mover_.empty() ? 0.0F : std::sqrt(2.0F * std::ranges::max(stiffness_of_mover_));
}

/// Returns the distance of its ends.
float SpringsAndRods::place(Held& link, std::span<Mover const> movers) {
    link.ends.place(movers);
    Vec2 const way_mm = link.ends.way_mm(movers);
    float const now_mm = length(way_mm);
    // Ends that coincide part along x, as centres of disks do.
    link.along = now_mm > 0.0F ? (1.0F / now_mm) * way_mm : Vec2{1.0F, 0.0F};
    link.mass = 1.0F / link.ends.inverse_mass(movers, link.along);
    if (link.is_rod()) {
        link.soft_mass = link.mass;
    }
    return now_mm;
}

void SpringsAndRods::begin_substep(std::span<Mover> movers, Times const& times) {
    bool const is_too_stiff = fastest_swing_rad_s() * times.h_s > kMostSwingRad;
    for (Held& link : links_) {
        float const now_mm = place(link, movers);
        float const excess_mm = now_mm - link.length_mm;
        if (link.is_rod()) {
            link.correcting_mm_s = -std::clamp(times.push_rate * excess_mm, -kFastestPushMmS, kFastestPushMmS);
        } else {
            float const resistance = link.damping + (is_too_stiff ? times.h_s * link.stiffness : 0.0F);
            float const drag = times.h_s * resistance;
            link.softness = drag > 0.0F ? 1.0F / drag : 0.0F;
            link.soft_mass = drag > 0.0F ? link.mass / (1.0F + link.mass * link.softness) : 0.0F;
            link.correcting_mm_s = is_too_stiff ? -link.stiffness / resistance * excess_mm : 0.0F;
            link.pull = is_too_stiff ? 0.0F : times.h_s * link.stiffness * excess_mm;
            link.ends.push(movers, -link.pull * link.along);
        }
    }
}

void SpringsAndRods::push_as_before(std::span<Mover> movers) {
    for (Held& link : links_) {
        link.ends.push(movers, link.held->push.x * link.along);
    }
}

void SpringsAndRods::begin_relaxing(std::span<Mover const> movers) {
    for (Held& link : links_) {
        if (link.is_rod()) {
            place(link, movers);
        }
    }
}

float SpringsAndRods::solve(Held& link, std::span<Mover> movers, bool pushes) {
    if (link.soft_mass == 0.0F) {
        return 0.0F;
    }
    float const speed_mm_s = dot(link.ends.parting_mm_s(movers), link.along);
    float const wanted_mm_s = pushes || !link.is_rod() ? link.correcting_mm_s : 0.0F;
    float const push = link.soft_mass * (wanted_mm_s - speed_mm_s - link.softness * link.held->push.x);
    link.held->push.x += push;
    link.ends.push(movers, push * link.along);
    return std::abs(push) / link.mass;
}

void SpringsAndRods::forget_impulses() {
    for (Held& link : links_) {
        *link.held = {};
    }
}

float SpringsAndRods::solve(std::span<Mover> movers, bool backwards, bool pushes) {
    float most_mm_s = 0.0F;
    for (std::size_t i = 0; i < links_.size(); ++i) {
        most_mm_s = std::max(most_mm_s, solve(links_[backwards ? links_.size() - 1 - i : i], movers, pushes));
    }
    return most_mm_s;
}

}  // namespace pogosim
