// Hinges of an island: points of two bodies that stay together, and how far the bodies may turn about them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/assemblies.hpp"
#include "physics/link_ends.hpp"
#include "physics/substep.hpp"

namespace pogosim {

/// How far `b` may turn against `a`, rad.
struct HingeLimits {
    float rest_rad = 0.0F;  // the difference of their headings from which it is counted
    float least_rad = -std::numeric_limits<float>::infinity();
    float most_rad = std::numeric_limits<float>::infinity();
};

class Hinges {
public:
    /// An island without any.
    void clear() { hinges_.clear(); }

    bool empty() const { return hinges_.empty(); }

    /// `held`: its impulse, which outlives the island.
    void add(LinkEnds const& ends, HingeLimits const& limits, HeldImpulse& held);

    /// Measures the hinges at the start of a sub-step.
    void begin_substep(std::span<Mover> movers, Times const& times);

    /// Applies the impulses of the last sub-step.
    void push_as_before(std::span<Mover> movers);

    /// Measures the hinges after the bodies have moved, before velocities are corrected.
    void begin_relaxing(std::span<Mover const> movers);

    /// Solves all once. `pushes`: ends that are apart are brought together. Returns the largest change of a speed,
    /// mm/s.
    float solve(std::span<Mover> movers, bool backwards, bool pushes);

    void forget_impulses();

    /// Impulse of a hinge in the present sub-step.
    Vec2 push_of(std::size_t hinge) const { return hinges_[hinge].held->push; }

private:
    struct Hinge {
        LinkEnds ends;
        HingeLimits limits;
        HeldImpulse* held;
        // Inverse masses for pushes along x and y: the symmetric matrix (xx xy; xy yy).
        float xx = 0.0F;
        float xy = 0.0F;
        float yy = 0.0F;
        Vec2 joining_mm_s{};  // velocity at which the ends come together
        float turn_mass = 0.0F;
        float least_rad_s = 0.0F;  // limits of the speed of turning in this sub-step
        float most_rad_s = 0.0F;

        bool has_limits() const { return limits.least_rad > -kUnlimited || limits.most_rad < kUnlimited; }
    };

    static constexpr float kUnlimited = std::numeric_limits<float>::infinity();

    static void place(Hinge& hinge, std::span<Mover const> movers);
    static float solve(Hinge& hinge, std::span<Mover> movers, bool pushes);
    static void solve_limits(Hinge& hinge, std::span<Mover> movers, bool pushes);
    static void measure_limits(Hinge& hinge, std::span<Mover const> movers, Times const& times);

    std::vector<Hinge> hinges_;
};

}  // namespace pogosim
