// The two points that a link or hinge holds to each other, among the movers of an island.
#pragma once

#include <cstdint>
#include <span>

#include "physics/mover.hpp"
#include "world/world.hpp"

namespace pogosim {

struct LinkEnds {
    std::uint32_t a;  // into the movers
    std::uint32_t b;
    Vec2 own_a_mm;  // in the body's own frame; with kStill: in the arena
    Vec2 own_b_mm;
    Vec2 seam_mm{};   // periodic world: to be added to the vector from `a` to `b`
    Vec2 arm_a_mm{};  // from the centre of each body, as it is turned now
    Vec2 arm_b_mm{};

    /// Turns the arms with the bodies.
    void place(std::span<Mover const> movers) {
        arm_a_mm = turned(own_a_mm, movers[a]);
        arm_b_mm = turned(own_b_mm, movers[b]);
    }

    /// Chooses the shortest way from `a` to `b`.
    void find_seam(World const& world, std::span<Mover const> movers) {
        Vec2 const from_mm = movers[a].position_mm + arm_a_mm;
        Vec2 const to_mm = movers[b].position_mm + arm_b_mm;
        seam_mm = world.periodic ? minimum_image(world, from_mm, to_mm) - (to_mm - from_mm) : Vec2{};
    }

    /// From the end at `a` to the end at `b`.
    Vec2 way_mm(std::span<Mover const> movers) const {
        return movers[b].position_mm + arm_b_mm + seam_mm - movers[a].position_mm - arm_a_mm;
    }

    /// How fast that changes.
    Vec2 parting_mm_s(std::span<Mover const> movers) const {
        return velocity_between(movers[b], movers[a], arm_b_mm, arm_a_mm);
    }

    /// Inverse mass for a push along a unit vector.
    float inverse_mass(std::span<Mover const> movers, Vec2 along) const {
        return pogosim::inverse_mass(movers[a], movers[b], arm_a_mm, arm_b_mm, along);
    }

    /// Applies an impulse to `b`, and its opposite to `a`.
    void push(std::span<Mover> movers, Vec2 impulse) const {
        pogosim::push(movers[a], arm_a_mm, -impulse);
        pogosim::push(movers[b], arm_b_mm, impulse);
    }

private:
    /// Most links are attached to centres.
    static Vec2 turned(Vec2 own_mm, Mover const& mover) {
        return own_mm == Vec2{} ? own_mm : rotate(own_mm, direction(mover.heading_rad));
    }
};

}  // namespace pogosim
