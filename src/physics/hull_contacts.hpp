// The contacts of an island in which at least one body is a movable hull: two touches at most, off the line of the
// centres, with normals that turn with the bodies.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/manifold.hpp"
#include "physics/mover.hpp"
#include "physics/near_contacts.hpp"
#include "physics/substep.hpp"
#include "world/world.hpp"

namespace pogosim {

class HullContacts {
public:
    /// An island without any.
    void clear();

    bool empty() const { return contacts_.empty(); }

    /// Adds a contact of NearContacts. `a`, `b`: its bodies in the movers; `b` is kStill if it is fixed.
    void add(World const& world, NearContacts const& contacts, std::uint32_t index, std::uint32_t a, std::uint32_t b,
             std::span<Mover const> movers);

    /// Finds the touches at the start of a sub-step, and the speeds that they demand. Returns whether any overlap.
    bool measure(NearContacts const& contacts, std::span<Mover const> movers, Times const& times);

    /// Applies the impulses of the last step that motors drove, where the same features touch.
    void push_as_before(NearContacts& contacts, std::span<Mover> movers);
    void keep_impulses(NearContacts& contacts) const;

    /// Solves all once. `pushes`: overlaps are pushed apart. Returns the largest change of a speed of separation, mm/s.
    float solve(std::span<Mover> movers, bool backwards, bool pushes);

private:
    /// A touch with what the solver needs.
    struct Point {
        Vec2 arm_a_mm;  // from the centre of each body
        Vec2 arm_b_mm;
        std::uint32_t features = 0;
        float least_mm_s = 0.0F;    // smallest speed of separation in this sub-step
        float relaxed_mm_s = 0.0F;  // the same after overlaps have been pushed apart
        float latest_mm_s = 0.0F;   // < 0; faster impacts cannot wait for the next sub-step
        float normal_mass = 0.0F;
        float tangent_mass = 0.0F;
        HullImpulse::Part impulse{};
    };

    struct Contact {
        std::uint32_t a;      // in the movers
        std::uint32_t b;      // the same; kStill
        std::uint32_t index;  // in NearContacts::near()
        std::uint32_t hull_a;
        std::uint32_t hull_b;  // in hulls_; kNone: a wall
        float friction;
        float restitution;
        Vec2 seam_mm;  // periodic world: to be added to the vector from `b` to `a`
        Vec2 normal{};
        std::array<Point, 2> points{};
        std::uint32_t count = 0;
    };

    /// The hull of a mover, or of something fixed, where it is now.
    struct Placed {
        Hull own;  // in its own frame
        Hull now;
        std::uint32_t mover;  // kStill: it stays
        Vec2 place_mm;        // of its origin
    };

    std::uint32_t hull_of(World const& world, NearContacts const& contacts, std::uint32_t body, std::uint32_t part,
                          std::uint32_t mover, std::span<Mover const> movers);
    Manifold touches(NearContacts const& contacts, Contact const& contact, float reach_mm) const;
    bool measure(Contact& contact, Manifold const& touches, std::span<Mover const> movers, Times const& times) const;
    static float solve(Contact const& contact, Point& point, std::span<Mover> movers, bool pushes);

    std::vector<Contact> contacts_;
    std::vector<Placed> hulls_;
    std::vector<std::uint32_t> hull_of_mover_;  // its first part in hulls_; valid only if that hull is the mover's
};

}  // namespace pogosim
