// The links of an island that act along the line between their ends: springs and rods.
//
// A spring pulls with the force at the start of a sub-step, which keeps the energy of an undamped one (symplectic
// Euler: E. Hairer, C. Lubich and G. Wanner, "Geometric numerical integration", 2006). Its damping is that at the end,
// which is stable however strong it is; so is the force of a spring that is too stiff for the shortest sub-steps. Rods
// and hinges are corrected in each sub-step, and velocities are then made to agree with where they are, as in "RATTLE":
// H. C. Andersen, Journal of Computational Physics 52 (1983) 24.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/assemblies.hpp"
#include "physics/link_ends.hpp"
#include "physics/substep.hpp"

namespace pogosim {

class SpringsAndRods {
public:
    /// An island without any.
    void clear();

    bool empty() const { return links_.empty(); }
    bool has_rods() const { return has_rods_; }

    /// `held`: its impulse, which outlives the island.
    void add(Link const& link, LinkEnds const& ends, HeldImpulse& held, std::span<Mover const> movers);

    /// At most how fast a rod turns.
    float fastest_turn_rad_s(std::span<Mover const> movers) const;

    /// At most the fastest oscillation of what is linked, rad/s: by Gershgorin's circle theorem.
    float fastest_swing_rad_s() const;

    /// Measures the links at the start of a sub-step, and lets springs pull.
    void begin_substep(std::span<Mover> movers, Times const& times);

    /// Applies the impulses of the last sub-step.
    void push_as_before(std::span<Mover> movers);

    /// Measures the rods after the bodies have moved, before velocities are corrected.
    void begin_relaxing(std::span<Mover const> movers);

    /// Solves all once. `pushes`: rods that are too long or too short are corrected. Returns the largest change of a
    /// speed, mm/s.
    float solve(std::span<Mover> movers, bool backwards, bool pushes);

    void forget_impulses();

    /// Impulse of a link in the present sub-step, positive when it pulls.
    float pull_of(std::size_t link) const { return links_[link].pull - links_[link].held->push.x; }

private:
    struct Held {
        LinkEnds ends;
        float length_mm;
        float stiffness;  // mass/s2, mass as that of bodies; of a rod: infinite
        float damping;    // mass/s
        HeldImpulse* held;
        Vec2 along{};  // unit vector from `a` to `b`
        float mass = 0.0F;
        float soft_mass = 0.0F;
        float softness = 0.0F;         // speed left per impulse; of a rod: 0
        float correcting_mm_s = 0.0F;  // speed at which a rod, or a spring that is too stiff, gets its length
        float pull = 0.0F;             // impulse of a spring that was applied at the start

        bool is_rod() const;
    };

    static float place(Held& link, std::span<Mover const> movers);
    static float solve(Held& link, std::span<Mover> movers, bool pushes);

    std::vector<Held> links_;
    bool has_rods_ = false;
    std::vector<float> stiffness_of_mover_;  // sums over its links, over its mass: 1/s2
};

}  // namespace pogosim
