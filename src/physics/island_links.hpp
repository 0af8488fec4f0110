// What holds the bodies of an island to each other and to the arena: the links of the world, and the hinges of
// membranes of segments.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/assemblies.hpp"
#include "physics/hinges.hpp"
#include "physics/springs_and_rods.hpp"

namespace pogosim {

class IslandLinks {
public:
    /// An island without any.
    void clear();

    bool empty() const { return springs_and_rods_.empty() && hinges_.empty(); }

    /// Adds what holds an assembly. `mover_of`: the place of each movable body of the world in the movers.
    void add(World const& world, Assemblies& assemblies, Assembly const& assembly, std::span<Mover const> movers,
             std::span<std::uint32_t const> mover_of);

    float fastest_swing_rad_s() const { return springs_and_rods_.fastest_swing_rad_s(); }
    float fastest_turn_rad_s(std::span<Mover const> movers) const {
        return springs_and_rods_.fastest_turn_rad_s(movers);
    }

    /// Whether there are rods or hinges. Each sub-step corrects where their bodies are, and then their velocities.
    bool has_rigid() const { return springs_and_rods_.has_rods() || !hinges_.empty(); }

    /// Measures all at the start of a sub-step, and lets springs pull.
    void begin_substep(std::span<Mover> movers, Times const& times);

    /// Applies the impulses of the last sub-step.
    void push_as_before(std::span<Mover> movers);

    /// Measures what is rigid after the bodies have moved, before velocities are corrected.
    void begin_relaxing(std::span<Mover const> movers);

    /// Solves all once. `pushes`: what is apart, too long or too short is corrected. Returns the largest change of a
    /// speed, mm/s.
    float solve(std::span<Mover> movers, bool backwards, bool pushes);

    void forget_impulses();

    /// Adds up the impulses of a sub-step.
    void end_substep();

    /// Writes the tensions: the mean over a time step.
    void write_tensions(World& world) const;

private:
    struct Given {
        std::uint32_t link;  // into World::links
        bool is_hinge;
        std::uint32_t place;  // in hinges_ or springs_and_rods_
        Vec2 impulse{};       // in this step; of a spring or rod: the first number, its pull
    };

    SpringsAndRods springs_and_rods_;
    Hinges hinges_;
    std::vector<Given> given_;
    std::uint32_t hinge_count_ = 0;
    std::uint32_t other_count_ = 0;
};

}  // namespace pogosim
