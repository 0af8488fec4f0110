// The springs and the areas of the membranes of an island, for one sub-step after the other.
//
// Springs are soft constraints, stable at every stiffness; with a limit to how far they stretch: E. Catto, "Soft
// Constraints", Game Developers Conference, 2011.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/membrane_area.hpp"
#include "physics/mover.hpp"
#include "world/world.hpp"

namespace pogosim {

/// What the spring of a joint has pulled with in the last sub-step: a first guess for the next one.
struct SpringImpulse {
    float spring = 0.0F;
    float limit = 0.0F;  // more, because it would have become too long
};

class SoftMembranes {
public:
    /// The membranes are at rest.
    explicit SoftMembranes(World const& world);

    /// Forgets the island before.
    void clear();

    /// Adds a membrane, an index into World::membranes, whose bodies are `movers[first]` and those that follow.
    /// `impulses`: of all joints of the world.
    void add(World const& world, std::uint32_t membrane, std::span<Mover const> movers, std::uint32_t first,
             std::span<SpringImpulse const> impulses);

    void forget_impulses();
    void keep_impulses(std::span<SpringImpulse> impulses) const;

    bool empty() const { return springs_.empty(); }

    /// Presses on the membranes for what they enclose, and looks where the springs are. `push_rate`: speed with which
    /// a spring that is too long is pulled back, in 1/s of what it is too long. Returns whether some are.
    bool begin_substep(std::span<Mover> movers, float h_s, float push_rate);

    /// A pass through all springs. Returns the largest change of a speed, mm/s. `relaxes`: springs that are too long
    /// stay so.
    float solve(std::span<Mover> movers, bool backwards, bool relaxes);

private:
    struct Spring {
        std::uint32_t a;  // into the movers
        std::uint32_t b;
        float length_mm;   // at rest
        float longest_mm;  // 0: no limit
        float omega;       // 2 pi times the natural frequency, 1/s
        float damping_ratio;
        Vec2 along{};  // to `b`, from `a`
        float mass = 0.0F;
        float soft_mass = 0.0F;
        float softness = 0.0F;      // speed that the spring leaves, per impulse in it
        float bias_mm_s = 0.0F;     // speed at which it shortens
        float most_mm_s = 0.0F;     // speed at which it may become longer
        float relaxed_mm_s = 0.0F;  // the same once it has been pulled back
        SpringImpulse impulse;
    };

    struct Added {
        std::uint32_t membrane;
        std::uint32_t first_mover;
        std::uint32_t mover_count;
        std::uint32_t first_spring;
    };

    struct Joints {
        std::uint32_t first;
        std::uint32_t count;
    };

    float solve(Spring& spring, std::span<Mover> movers, bool relaxes);

    std::vector<MembraneArea> areas_;  // of each membrane of the world
    std::vector<Joints> joints_;       // the same: in World::joints
    std::vector<Spring> springs_;
    std::vector<Added> added_;
};

}  // namespace pogosim
