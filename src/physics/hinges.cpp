#include "physics/hinges.hpp"

#include <algorithm>
#include <cmath>

namespace pogosim {

namespace {

// Limits are exceeded by so much before they push.
constexpr float kSlackRad = 1e-4F;
constexpr float kFastestTurnRadS = 20.0F;

void turn(std::span<Mover> movers, LinkEnds const& ends, float impulse) {
    movers[ends.a].angular_velocity_rad_s -= movers[ends.a].inverse_inertia * impulse;
    movers[ends.b].angular_velocity_rad_s += movers[ends.b].inverse_inertia * impulse;
}

}  // namespace

void Hinges::add(LinkEnds const& ends, HingeLimits const& limits, HeldImpulse& held) {
    hinges_.push_back({.ends = ends, .limits = limits, .held = &held});
}

void Hinges::place(Hinge& hinge, std::span<Mover const> movers) {
    LinkEnds& ends = hinge.ends;
    ends.place(movers);
    hinge.xx = ends.inverse_mass(movers, {1.0F, 0.0F});
    hinge.yy = ends.inverse_mass(movers, {0.0F, 1.0F});
    hinge.xy = -movers[ends.a].inverse_inertia * ends.arm_a_mm.x * ends.arm_a_mm.y -
               movers[ends.b].inverse_inertia * ends.arm_b_mm.x * ends.arm_b_mm.y;
}

void Hinges::begin_relaxing(std::span<Mover const> movers) {
    for (Hinge& hinge : hinges_) {
        place(hinge, movers);
    }
}

void Hinges::begin_substep(std::span<Mover> movers, Times const& times) {
    for (Hinge& hinge : hinges_) {
        LinkEnds& ends = hinge.ends;
        place(hinge, movers);
        Vec2 const way_mm = ends.way_mm(movers);
        float const apart_mm = length(way_mm);
        float const rate = apart_mm * times.push_rate > kFastestPushMmS ? kFastestPushMmS / apart_mm : times.push_rate;
        hinge.joining_mm_s = -rate * way_mm;
        if (hinge.has_limits()) {
            measure_limits(hinge, movers, times);
        }
    }
}

void Hinges::push_as_before(std::span<Mover> movers) {
    for (Hinge& hinge : hinges_) {
        hinge.ends.push(movers, hinge.held->push);
        if (hinge.has_limits()) {
            turn(movers, hinge.ends, hinge.held->least + hinge.held->most);
        }
    }
}

void Hinges::measure_limits(Hinge& hinge, std::span<Mover const> movers, Times const& times) {
    Mover const& a = movers[hinge.ends.a];
    Mover const& b = movers[hinge.ends.b];
    HingeLimits const& limits = hinge.limits;
    // Near the angle of the last sub-step: half a turn to one side is not half a turn to the other.
    float& angle_rad = hinge.held->angle_rad;
    angle_rad += wrap_angle(b.heading_rad - a.heading_rad - limits.rest_rad - angle_rad);
    float const inverse_inertia = a.inverse_inertia + b.inverse_inertia;
    hinge.turn_mass = inverse_inertia > 0.0F ? 1.0F / inverse_inertia : 0.0F;
    // Within the limits, they may be reached in this sub-step; beyond, they push back.
    auto const speed = [&](float free_rad) {
        return free_rad >= -kSlackRad ? std::max(free_rad, 0.0F) * times.per_h
                                      : std::max(free_rad * times.push_rate, -kFastestTurnRadS);
    };
    hinge.least_rad_s = -speed(angle_rad - limits.least_rad);
    hinge.most_rad_s = speed(limits.most_rad - angle_rad);
}

void Hinges::solve_limits(Hinge& hinge, std::span<Mover> movers, bool pushes) {
    HeldImpulse& held = *hinge.held;
    auto const spin_rad_s = [&] {
        return movers[hinge.ends.b].angular_velocity_rad_s - movers[hinge.ends.a].angular_velocity_rad_s;
    };
    float const least_rad_s = pushes ? hinge.least_rad_s : std::min(hinge.least_rad_s, 0.0F);
    float const most_rad_s = pushes ? hinge.most_rad_s : std::max(hinge.most_rad_s, 0.0F);
    if (least_rad_s > -kUnlimited) {
        float const before = held.least;
        held.least = std::max(before + hinge.turn_mass * (least_rad_s - spin_rad_s()), 0.0F);
        turn(movers, hinge.ends, held.least - before);
    }
    if (most_rad_s < kUnlimited) {
        float const before = held.most;
        held.most = std::min(before + hinge.turn_mass * (most_rad_s - spin_rad_s()), 0.0F);
        turn(movers, hinge.ends, held.most - before);
    }
}

float Hinges::solve(Hinge& hinge, std::span<Mover> movers, bool pushes) {
    if (hinge.has_limits()) {
        solve_limits(hinge, movers, pushes);
    }
    float const determinant = hinge.xx * hinge.yy - hinge.xy * hinge.xy;
    if (!(determinant > 0.0F)) {
        return 0.0F;
    }
    Vec2 const wanted_mm_s = pushes ? hinge.joining_mm_s : Vec2{};
    Vec2 const change_mm_s = wanted_mm_s - hinge.ends.parting_mm_s(movers);
    Vec2 const impulse = (1.0F / determinant) * Vec2{hinge.yy * change_mm_s.x - hinge.xy * change_mm_s.y,
                                                     hinge.xx * change_mm_s.y - hinge.xy * change_mm_s.x};
    hinge.held->push = hinge.held->push + impulse;
    hinge.ends.push(movers, impulse);
    return length(change_mm_s);
}

void Hinges::forget_impulses() {
    for (Hinge& hinge : hinges_) {
        *hinge.held = {.push = {}, .angle_rad = hinge.held->angle_rad};
    }
}

float Hinges::solve(std::span<Mover> movers, bool backwards, bool pushes) {
    float most_mm_s = 0.0F;
    for (std::size_t i = 0; i < hinges_.size(); ++i) {
        most_mm_s = std::max(most_mm_s, solve(hinges_[backwards ? hinges_.size() - 1 - i : i], movers, pushes));
    }
    return most_mm_s;
}

}  // namespace pogosim
