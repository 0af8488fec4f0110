// Contacts of disks with each other and with walls, solved in sub-steps.
//
// Sequential impulses with accumulated clamping: E. Catto, "Iterative dynamics with temporal coherence", Game
// Developers Conference 2005. Sub-steps: M. Macklin et al., "Small steps in physics simulation", Symposium on Computer
// Animation 2019. Overlaps are pushed apart by soft constraints, whose speed is taken back after the positions have
// moved ("relaxation"), so that they add no energy: E. Catto, "Solver2D" (2024).
//
// Bodies that touch, directly or through others, are an island (D. Baraff, "Rigid body simulation", SIGGRAPH course
// notes 1997). Islands are solved one by one, each until it has converged, so that a jam somewhere costs nothing
// elsewhere.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/near_pairs.hpp"
#include "physics/near_walls.hpp"
#include "world/world.hpp"

namespace pogosim {

class DiskSolver {
public:
    DiskSolver(World const& world, WallSpec const& walls);

    /// Takes the contacts whose gap is less than `reach_mm` now.
    void find_contacts(World const& world, NearPairs const& pairs, NearWalls const& walls, float reach_mm);

    /// Moves all bodies that have a contact by one time step: poses, but for heading_dir, and velocities.
    void solve(World& world, NearWalls const& walls);

    /// Whether find_contacts() has found one for the body.
    bool has_contact(std::uint32_t body) const { return has_contact_[body] != 0; }

    /// Bodies with contacts, each once.
    std::span<std::uint32_t const> touched() const { return touched_; }

    /// Whether some disks overlapped after the last solve() by more than a tolerance.
    bool has_overlaps() const { return has_overlaps_; }

private:
    /// What a body is to the solver, for the whole run.
    struct Disk {
        float radius_mm;
        float inverse_mass;     // 0: fixed
        float inverse_inertia;  // 1 / (mass mm^2)
        float friction;
        float restitution;
    };

    /// Of two disks, or of a disk and a wall.
    struct Contact {
        std::uint32_t a;
        std::uint32_t b;     // kNone: a wall
        std::uint32_t edge;  // of the wall
        float radius_mm;     // the sum of both
        float normal_mass;
        float tangent_mass;
        float friction;
        float restitution;
        Vec2 normal{};  // to `a`, from `b` or from the wall
        float gap_mm = 0.0F;
        float speed_mm_s = 0.0F;   // of separation, at the start of the sub-step
        float bounce_mm_s = 0.0F;  // speed of separation after an impact in this sub-step; 0: none
        float normal_impulse = 0.0F;
        float tangent_impulse = 0.0F;
        std::uint64_t solved = 0;  // when

        bool is_wall() const { return b == kNone; }
    };

    /// Contacts and bodies that have nothing to do with others: ranges of contacts_ and touched_.
    struct Island {
        std::uint32_t first_contact;
        std::uint32_t last_contact;
        std::uint32_t first_body;
        std::uint32_t last_body;
    };

    void touch(std::uint32_t body);
    std::uint32_t root_of(std::uint32_t body);
    void add_pair(World const& world, NearPair const& pair, float reach_mm);
    void add_wall(World const& world, NearWalls const& walls, NearWall const& wall, float reach_mm);
    void sort_into_islands();

    void changed_now(Island const& island);
    void solve_island(World& world, NearWalls const& walls, Island const& island, float dt_s);
    void measure(World const& world, NearWalls const& walls, Contact& contact, float h_s) const;
    void solve_velocities(Bodies& bodies, std::span<Contact> contacts, float h_s, bool pushes);
    float solve_contact(Bodies& bodies, Contact& contact, float h_s, bool pushes) const;

    std::vector<Disk> disks_;
    WallSpec wall_;

    std::vector<Contact> found_;     // in the order of the pairs, then of the walls
    std::vector<Contact> contacts_;  // by island, else in the same order
    std::vector<Island> islands_;
    std::vector<std::uint32_t> parent_;  // of each touched body, in the forest of islands
    std::vector<std::uint32_t> island_;  // of each root
    std::vector<std::uint8_t> has_contact_;
    std::uint64_t clock_ = 0;             // counts solved contacts
    std::vector<std::uint64_t> changed_;  // of each body: when a contact last changed its velocity
    std::vector<std::uint32_t> found_bodies_;
    std::vector<std::uint32_t> touched_;  // by island
    bool has_overlaps_ = false;
};

}  // namespace pogosim
