#include "physics/island_links.hpp"

#include <algorithm>

#include "physics/body_mass.hpp"
#include "world/link_places.hpp"

namespace pogosim {

namespace {

/// The end of a link at a body, or at a place of the arena, to which fixed bodies belong.
struct End {
    std::uint32_t mover;
    Vec2 own_mm;
    float heading_rad;  // of what does not move
};

End end_at(World const& world, std::uint32_t body, Vec2 own_mm, std::span<std::uint32_t const> mover_of) {
    if (body == kNone) {
        return {kStill, own_mm, 0.0F};
    }
    Bodies const& bodies = world.bodies;
    if (bodies.spec[body].fixed) {
        return {kStill, place_on_body(bodies, body, own_mm), bodies.heading_rad[body]};
    }
    return {mover_of[body], own_mm, 0.0F};
}

}  // namespace

void IslandLinks::clear() {
    springs_and_rods_.clear();
    hinges_.clear();
    given_.clear();
    hinge_count_ = other_count_ = 0;
}

void IslandLinks::add(World const& world, Assemblies& assemblies, Assembly const& assembly,
                      std::span<Mover const> movers, std::span<std::uint32_t const> mover_of) {
    for (std::uint32_t const i : assembly.hinges) {
        Joint const& joint = world.joints[i];
        LinkEnds const ends{.a = mover_of[joint.a],
                            .b = mover_of[joint.b],
                            .own_a_mm = joint.anchor_a_mm,
                            .own_b_mm = joint.anchor_b_mm};
        hinges_.add(ends, {}, assemblies.impulse_of_joint(i));
        ++hinge_count_;
    }
    for (std::uint32_t const i : assembly.links) {
        Link const& link = world.links[i];
        End const a = end_at(world, link.a, link.end_a_mm, mover_of);
        End const b = end_at(world, link.b, link.end_b_mm, mover_of);
        LinkEnds ends{.a = a.mover, .b = b.mover, .own_a_mm = a.own_mm, .own_b_mm = b.own_mm};
        ends.place(movers);
        ends.find_seam(world, movers);
        bool const is_hinge = link.kind == LinkKind::hinge;
        if (is_hinge) {
            HingeLimits const limits{.rest_rad = link.rest_rad - b.heading_rad + a.heading_rad,
                                     .least_rad = link.least_rad,
                                     .most_rad = link.most_rad};
            hinges_.add(ends, limits, assemblies.impulse_of_link(i));
        } else {
            springs_and_rods_.add(link, ends, assemblies.impulse_of_link(i), movers);
        }
        given_.push_back({.link = i, .is_hinge = is_hinge, .place = is_hinge ? hinge_count_++ : other_count_++});
    }
}

void IslandLinks::begin_substep(std::span<Mover> movers, Times const& times) {
    springs_and_rods_.begin_substep(movers, times);
    hinges_.begin_substep(movers, times);
}

void IslandLinks::push_as_before(std::span<Mover> movers) {
    springs_and_rods_.push_as_before(movers);
    hinges_.push_as_before(movers);
}

void IslandLinks::begin_relaxing(std::span<Mover const> movers) {
    springs_and_rods_.begin_relaxing(movers);
    hinges_.begin_relaxing(movers);
}

float IslandLinks::solve(std::span<Mover> movers, bool backwards, bool pushes) {
    // One after the other: the order of arguments is the compiler's.
    float const most_mm_s = springs_and_rods_.solve(movers, backwards, pushes);
    return std::max(most_mm_s, hinges_.solve(movers, backwards, pushes));
}

void IslandLinks::forget_impulses() {
    springs_and_rods_.forget_impulses();
    hinges_.forget_impulses();
}

void IslandLinks::end_substep() {
    for (Given& given : given_) {
        given.impulse = given.impulse + (given.is_hinge ? hinges_.push_of(given.place)
                                                        : Vec2{springs_and_rods_.pull_of(given.place), 0.0F});
    }
}

void IslandLinks::write_tensions(World& world) const {
    float const per_newton = kForcePerNewton * static_cast<float>(world.time_step_s);
    for (Given const& given : given_) {
        float const impulse = given.is_hinge ? length(given.impulse) : given.impulse.x;
        world.links[given.link].tension_n = impulse / per_newton;
    }
}

}  // namespace pogosim
