// Moves the bodies of one island of contacts by a time step, in sub-steps.
//
// Sequential impulses with accumulated clamping: E. Catto, "Iterative dynamics with temporal coherence", Game
// Developers Conference 2005. Sub-steps: M. Macklin et al., "Small steps in physics simulation", Symposium on Computer
// Animation 2019. Overlaps are pushed apart by soft constraints, whose speed is taken back after the positions have
// moved ("relaxation"), so that they add no energy: E. Catto, "Solver2D" (2024).
//
// The solver works on a contiguous copy of the bodies and contacts of the island, and solves a contact again only if
// the velocity of one of its bodies has changed since. In an island with hulls, soft membranes or links, each iteration
// solves all contacts, springs, rods and hinges, and fast bodies have more sub-steps.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/four.hpp"
#include "physics/assemblies.hpp"
#include "physics/hull_contacts.hpp"
#include "physics/island_links.hpp"
#include "physics/islands.hpp"
#include "physics/mover.hpp"
#include "physics/near_contacts.hpp"
#include "physics/soft_membranes.hpp"
#include "physics/substep.hpp"
#include "world/world.hpp"

namespace pogosim {

class IslandSolver {
public:
    explicit IslandSolver(World const& world);

    /// Moves the bodies of an island by one time step: poses (except heading_dir) and velocities. Returns whether any
    /// of them overlap at the end. `is_driven`: motors have just changed velocities.
    bool solve(World& world, Assemblies& assemblies, NearContacts& contacts, Islands const& islands,
               Island const& island, bool is_driven);

    /// Prefetches the bodies of an island that will be solved soon.
    void expect(World const& world, NearContacts const& contacts, Islands const& islands, Island const& island) const;

private:
    struct Contact {
        std::uint32_t a;     // into movers_
        std::uint32_t b;     // the same; kStill: something fixed
        std::uint32_t near;  // into NearContacts::near()
        ContactLaw law;
        Vec2 seam_mm;   // periodic world: to be added to the vector from `b` to `a`
        Vec2 normal{};  // unit vector from `b` to `a`
        float gap_mm = 0.0F;
        float least_mm_s = 0.0F;    // smallest speed of separation in this sub-step
        float relaxed_mm_s = 0.0F;  // the same after overlaps have been pushed apart
        float latest_mm_s = 0.0F;   // < 0; faster impacts cannot wait for the next sub-step
        float normal_impulse = 0.0F;
        float tangent_impulse = 0.0F;
        std::int32_t solved = 0;  // at which count of clock_; -1: not yet, and it has to be

        float demanded_mm_s(bool pushes) const { return pushes ? least_mm_s : relaxed_mm_s; }
    };

    /// State of the contacts at the start of a sub-step.
    struct Survey {
        bool overlaps = false;
        bool meets = false;  // before the end of the step, on straight lines
    };

    /// Geometry of four contacts, and their speeds of separation.
    struct Places {
        Four normal_x;
        Four normal_y;
        Four gap_mm;
        Four speed_mm_s;
        Four restitution;
    };

    bool solve_soft(World const& world, NearContacts& contacts, bool is_driven);
    int substeps_of(float dt_s) const;
    void find_close_contacts(float per_h, std::int32_t now);
    void solve_velocities_softly(float h_s, bool pushes);
    /// Disks alone may turn as fast as they like.
    bool turns_matter() const { return !hulls_.empty() || !links_.empty(); }
    float fastest_mm_s() const;
    float fastest_turn_rad_s() const;
    bool limit_speeds(float most_mm_s, float most_rad_s);
    std::uint32_t mover_of(World const& world, NearContacts const& contacts, std::uint32_t body);
    void gather(World const& world, Assemblies& assemblies, NearContacts const& contacts, Islands const& islands,
                Island const& island);
    void scatter(World& world);
    Survey measure(World const& world, NearContacts const& contacts, Times const& times);
    Places find_places(World const& world, NearContacts const& contacts, std::span<Contact const> four,
                       std::uint32_t first) const;
    int substeps_to_impact(Times const& times) const;
    void move(float time_s);
    void push_as_before(std::vector<float> const& driven_impulse);
    void keep_impulses(std::vector<float>& driven_impulse) const;
    double kinetic_energy(Vec2 drift_mm_s) const;
    Vec2 drift_mm_s() const;
    bool limit_energy(double most);
    void mark(Contact& contact);
    void mark_overlaps();
    void solve_velocities(float h_s, bool pushes);
    void solve_block(std::uint32_t block, bool backwards, float h_s, bool pushes);
    void solve_if_changed(Contact& contact, std::uint64_t clean_block, float h_s, bool pushes);
    float solve_contact(Contact& contact, float demanded_mm_s);

    std::vector<Mover> movers_;  // the first one represents everything that is fixed
    std::vector<Contact> contacts_;
    std::uint32_t pair_count_ = 0;      // contacts between two movable bodies, which come first
    std::vector<std::uint32_t> close_;  // into contacts_, when soft islands are solved
    std::vector<std::uint32_t> far_;
    HullContacts hulls_;
    SoftMembranes membranes_;
    IslandLinks links_;
    float most_motion_mm_;  // in a sub-step, in worlds with membranes

    // Contacts lie in up to 64 blocks of 2^block_shift_. A dirty block has contacts to solve again.
    std::uint64_t dirty_ = 0;
    std::uint32_t block_shift_ = 0;
    std::int32_t clock_ = 0;  // counts solved contacts in a sub-step

    std::vector<std::uint32_t> mover_;  // of each body; valid only if that mover is the body's
};

}  // namespace pogosim
