#include "physics/soft_membranes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/membrane_steps.hpp"

namespace pogosim {

namespace {

// Hinges answer to a push a few sub-steps later, as it has to travel round the membrane.
constexpr float kSwingsOfHinged = 0.0625F;

/// Bodies of the world.
struct LineAtRest {
    std::span<Vec2 const> position_mm;

    std::size_t size() const { return position_mm.size(); }
    Vec2 position(std::size_t i) const { return position_mm[i]; }
    static Vec2 velocity(std::size_t /*i*/) { return {}; }
    static float inverse_mass(std::size_t /*i*/) { return 0.0F; }
    static void push(std::size_t /*i*/, Vec2 /*change*/) {}
};

/// Bodies of an island.
struct LineOfMovers {
    std::span<Mover> movers;

    std::size_t size() const { return movers.size(); }
    Vec2 position(std::size_t i) const { return movers[i].position_mm; }
    Vec2 velocity(std::size_t i) const { return movers[i].velocity_mm_s; }
    float inverse_mass(std::size_t i) const { return movers[i].inverse_mass; }
    void push(std::size_t i, Vec2 change) const { movers[i].velocity_mm_s = movers[i].velocity_mm_s + change; }
};

}  // namespace

SoftMembranes::SoftMembranes(World const& world) {
    for (Membrane const& membrane : world.membranes) {
        // Joints are in the order of the membranes.
        auto const is_before = [](std::uint32_t body) { return [body](Joint const& joint) { return joint.a < body; }; };
        auto const first = std::ranges::partition_point(world.joints, is_before(membrane.body));
        auto const last = std::ranges::partition_point(world.joints, is_before(membrane.body + membrane.body_count));
        bool const has_hinges = std::any_of(first, last, [](Joint const& joint) { return joint.length_mm == 0.0F; });
        areas_.emplace_back(LineAtRest{std::span(world.bodies.position_mm).subspan(membrane.body, membrane.body_count)},
                            has_hinges ? kSwingsOfHinged : MembraneArea::kStiff);
        joints_.push_back(
            {static_cast<std::uint32_t>(first - world.joints.begin()), static_cast<std::uint32_t>(last - first)});
    }
}

void SoftMembranes::clear() {
    springs_.clear();
    added_.clear();
}

void SoftMembranes::add(World const& world, std::uint32_t membrane, std::span<Mover const> movers, std::uint32_t first,
                        std::span<SpringImpulse const> impulses) {
    std::uint32_t const first_body = world.membranes[membrane].body;
    added_.push_back({.membrane = membrane, .first_mover = first, .mover_count = world.membranes[membrane].body_count});
    float const stiffest_hz = kMostSwingsPerStep / static_cast<float>(world.time_step_s);
    auto const [first_joint, joint_count] = joints_[membrane];
    for (std::uint32_t i = first_joint; i < first_joint + joint_count; ++i) {
        Joint const& joint = world.joints[i];
        if (joint.length_mm == 0.0F) {
            continue;
        }
        std::uint32_t const a = first + (joint.a - first_body);
        std::uint32_t const b = first + (joint.b - first_body);
        springs_.push_back({.joint = i,
                            .a = a,
                            .b = b,
                            .length_mm = joint.length_mm,
                            .longest_mm = (1.0F + joint.max_stretch) * joint.length_mm * (joint.max_stretch > 0.0F),
                            .omega = 2.0F * std::numbers::pi_v<float> * std::min(joint.stiffness_hz, stiffest_hz),
                            .damping_ratio = joint.damping_ratio,
                            .mass = 1.0F / (movers[a].inverse_mass + movers[b].inverse_mass),
                            .impulse = impulses[i]});
    }
}

void SoftMembranes::forget_impulses() {
    for (Spring& spring : springs_) {
        spring.impulse = {};
    }
}

void SoftMembranes::keep_impulses(std::span<SpringImpulse> impulses) const {
    for (Spring const& spring : springs_) {
        impulses[spring.joint] = spring.impulse;
    }
}

bool SoftMembranes::begin_substep(std::span<Mover> movers, float h_s, float push_rate) {
    bool is_too_long = false;
    for (Added const& added : added_) {
        areas_[added.membrane].push(LineOfMovers{movers.subspan(added.first_mover, added.mover_count)}, h_s);
    }
    for (Spring& spring : springs_) {
        Vec2 const way_mm = movers[spring.b].position_mm - movers[spring.a].position_mm;
        float const now_mm = length(way_mm);
        spring.along = now_mm > 0.0F ? (1.0F / now_mm) * way_mm : Vec2{};
        float const h_omega = h_s * spring.omega;
        float const hardness = h_omega * (2.0F * spring.damping_ratio + h_omega);
        spring.soft_mass = spring.mass * hardness / (1.0F + hardness);
        spring.softness = 1.0F / (spring.mass * hardness);
        spring.bias_mm_s = (now_mm - spring.length_mm) * h_omega * spring.omega / hardness;
        float const slack_mm = spring.longest_mm - now_mm;
        is_too_long = is_too_long || (spring.longest_mm > 0.0F && slack_mm < 0.0F);
        spring.most_mm_s = slack_mm > 0.0F ? slack_mm / h_s : slack_mm * push_rate;
        spring.relaxed_mm_s = std::max(spring.most_mm_s, 0.0F);
        Vec2 const pull = (spring.impulse.spring + spring.impulse.limit) * spring.along;
        Mover& a = movers[spring.a];
        Mover& b = movers[spring.b];
        a.velocity_mm_s = a.velocity_mm_s - a.inverse_mass * pull;
        b.velocity_mm_s = b.velocity_mm_s + b.inverse_mass * pull;
    }
    return is_too_long;
}

float SoftMembranes::solve(Spring& spring, std::span<Mover> movers, bool relaxes) {
    Mover& a = movers[spring.a];
    Mover& b = movers[spring.b];
    float speed_mm_s = dot(b.velocity_mm_s - a.velocity_mm_s, spring.along);
    float push = -spring.soft_mass * (speed_mm_s + spring.bias_mm_s + spring.softness * spring.impulse.spring);
    spring.impulse.spring += push;
    if (spring.longest_mm > 0.0F) {
        speed_mm_s += push / spring.mass;
        float const before = spring.impulse.limit;
        float const most_mm_s = relaxes ? spring.relaxed_mm_s : spring.most_mm_s;
        spring.impulse.limit = std::min(before - spring.mass * (speed_mm_s - most_mm_s), 0.0F);
        push += spring.impulse.limit - before;
    }
    a.velocity_mm_s = a.velocity_mm_s - push * a.inverse_mass * spring.along;
    b.velocity_mm_s = b.velocity_mm_s + push * b.inverse_mass * spring.along;
    return std::abs(push) / spring.mass;
}

float SoftMembranes::solve(std::span<Mover> movers, bool backwards, bool relaxes) {
    float most_mm_s = 0.0F;
    for (std::size_t i = 0; i < springs_.size(); ++i) {
        Spring& spring = springs_[backwards ? springs_.size() - 1 - i : i];
        most_mm_s = std::max(most_mm_s, solve(spring, movers, relaxes));
    }
    return most_mm_s;
}

}  // namespace pogosim
