// Springs and areas of the membranes of an island, solved sub-step by sub-step.
//
// Springs are soft constraints, stable at every stiffness; with a limit to how far they stretch: E. Catto, "Soft
// Constraints", Game Developers Conference, 2011.
#pragma once

#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "base/four.hpp"
#include "physics/membrane_area.hpp"
#include "physics/mover.hpp"
#include "physics/spring_groups.hpp"
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

    /// Notes which movers are pushed by more than springs in this sub-step: `all`, or those with contacts, which have
    /// been marked as changed `now`.
    void note_pushed(std::span<Mover const> movers, std::int32_t now, bool all);

    /// Iterations begin, and end. Between them, only those movers that were noted have their velocities.
    void begin_iterations(std::span<Mover const> movers);
    void end_iterations(std::span<Mover> movers) const;

    /// One iteration over all springs. Returns the largest change of a speed, mm/s. `relaxes`: springs that are too
    /// long are not pulled back.
    float solve(std::span<Mover> movers, bool backwards, bool relaxes);

private:
    template <std::uint32_t kShift>
    using Shift = std::integral_constant<std::uint32_t, kShift>;

    /// Four dots, one of each arc: see SpringGroups.
    struct Row {
        Four x_mm_s{};
        Four y_mm_s{};
        Four x_mm{};
        Four y_mm{};
        Four inverse_mass{};
    };

    /// The springs of a group. Impulses are positive if they push the ends apart.
    struct Springs {
        std::uint32_t row_a;  // into rows_
        std::uint32_t row_b;
        std::uint32_t shift;  // see SpringGroup
        Four along_x{};       // unit vector from `a` to `b`
        Four along_y{};
        Four change_a_x{};  // of the velocity of `a`, per impulse
        Four change_a_y{};
        Four change_b_x{};
        Four change_b_y{};
        Four inverse_mass{};
        Four soft_mass{};
        Four left_mass{};  // the rest of the mass
        Four left{};       // the share of the impulse that softness takes back
        Four pull{};       // impulse at no speed
        Four most{};       // impulse that makes it as long as it may be
        Four relaxed{};    // the same after it has been pulled back
        Four impulse{};    // see SpringImpulse
        Four limit{};
        Four mass{};
        Four inverse_mass_a{};
        Four inverse_mass_b{};
        Four omega{};  // 2 pi times the natural frequency, 1/s
    };

    struct Added {
        std::uint32_t membrane;
        std::uint32_t first_mover;
        std::uint32_t first_row;
        std::uint32_t first_spring;
    };

    struct Dot {
        std::uint32_t mover;
        std::uint32_t row;
        std::uint32_t lane;
    };

    /// Calls `what` with the mover of each dot, its row and its lane, if the membrane has springs.
    template <class What>
    void for_each_dot(Added const& added, What what);

    void read_velocities(std::span<Mover const> movers, std::span<Dot const> dots);
    void write_velocities(std::span<Mover> movers, std::span<Dot const> dots) const;

    FourInts measure(Springs& springs, SpringGroup const& group, float h_s, float push_rate) const;

    template <std::uint32_t kShift>
    void push(Springs const& springs, Four impulse, Shift<kShift> shift);

    template <std::uint32_t kShift>
    Four solve(Springs& springs, bool relaxes, Shift<kShift> shift);

    std::vector<MembraneArea> areas_;    // for each membrane of the world
    std::vector<SpringGroups> grouped_;  // the same
    std::vector<Added> added_;
    std::vector<Springs> springs_;
    std::vector<Row> rows_;
    std::vector<Dot> pushed_;
    std::vector<Dot> others_;
};

}  // namespace pogosim
