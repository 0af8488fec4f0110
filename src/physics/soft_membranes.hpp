// Springs and areas of the membranes of an island, solved sub-step by sub-step.
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

/// Impulses of the spring of a joint in the last sub-step: the initial guess for the next one.
struct SpringImpulse {
    float spring = 0.0F;
    float limit = 0.0F;  // added because it would have become too long
};

class SoftMembranes {
public:
    /// Takes the present shapes of the membranes as those at rest.
    explicit SoftMembranes(World const& world);

    /// Begins a new island.
    void clear();

    /// Adds a membrane, an index into World::membranes, whose bodies are `movers[first]` and those that follow.
    /// `impulses`: of all joints of the world. Its hinges are left out, see IslandLinks.
    void add(World const& world, std::uint32_t membrane, std::span<Mover const> movers, std::uint32_t first,
             std::span<SpringImpulse const> impulses);

    void forget_impulses();
    void keep_impulses(std::span<SpringImpulse> impulses) const;

    bool empty() const { return added_.empty(); }

    /// Pushes the membranes towards their areas, and measures the springs. `push_rate`: speed at which a spring that is
    /// too long is pulled back, per mm of excess length, 1/s. Returns whether any spring is too long.
    bool begin_substep(std::span<Mover> movers, float h_s, float push_rate);

    /// One iteration over all springs. Returns the largest change of a speed, mm/s. `relaxes`: springs that are too
    /// long are not pulled back.
    float solve(std::span<Mover> movers, bool backwards, bool relaxes);

private:
    struct Spring {
        std::uint32_t joint;  // into World::joints
        std::uint32_t a;      // into the movers
        std::uint32_t b;
        float length_mm;   // at rest
        float longest_mm;  // 0: no limit
        float omega;       // 2 pi times the natural frequency, 1/s
        float damping_ratio;
        Vec2 along{};  // unit vector from `a` to `b`
        float mass = 0.0F;
        float soft_mass = 0.0F;
        float softness = 0.0F;      // speed left by the spring, per impulse
        float bias_mm_s = 0.0F;     // speed at which it shortens
        float most_mm_s = 0.0F;     // highest speed at which it may lengthen
        float relaxed_mm_s = 0.0F;  // the same after it has been pulled back
        SpringImpulse impulse;
    };

    struct Added {
        std::uint32_t membrane;
        std::uint32_t first_mover;
        std::uint32_t mover_count;
    };

    struct Joints {
        std::uint32_t first;
        std::uint32_t count;
    };

    float solve(Spring& spring, std::span<Mover> movers, bool relaxes);

    std::vector<MembraneArea> areas_;  // for each membrane of the world
    std::vector<Joints> joints_;       // for each membrane, in World::joints
    std::vector<Spring> springs_;
    std::vector<Added> added_;
};

}  // namespace pogosim
