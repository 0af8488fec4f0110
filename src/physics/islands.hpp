// Bodies that touch, directly or through others, are an island: D. Baraff, "Rigid body simulation", SIGGRAPH course
// notes 1997. Within a time step, islands do not interact. Walls and fixed bodies do not connect the bodies that touch
// them; bodies that joints and links hold together are always in one island.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/worker_pool.hpp"
#include "physics/assemblies.hpp"
#include "physics/near_contacts.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Contacts of one island: a list in Islands::contacts(). Its assemblies: a list in Islands::next_assemblies().
struct Island {
    std::uint32_t first = kNone;  // kNone: no contacts, only a moving assembly
    std::uint32_t last = kNone;
    std::uint32_t contact_count = 0;
    std::uint32_t first_assembly = kNone;
    bool is_active = false;  // bodies touch within this step, or an assembly moves
};

struct IslandContact {
    std::uint32_t contact;  // into NearContacts::near()
    std::uint32_t next;     // into Islands::contacts(); kNone: the last one
};

struct Reach {
    float reach_mm;                 // bodies with smaller gaps are in one island
    bool wakes_assemblies = false;  // those at rest count as moving
};

class Islands {
public:
    /// Finds the islands for the present positions and velocities.
    void find(World const& world, Assemblies const& assemblies, NearContacts const& contacts, Reach const& reach,
              WorkerPool& workers);

    /// Sorted by their first contacts; islands that are a single assembly come last. The contacts of each are in the
    /// order of NearContacts::near().
    std::span<Island const> islands() const { return std::span(islands_).subspan(1); }
    std::span<IslandContact const> contacts() const { return contacts_; }

    /// For each assembly, the next one in the same island; kNone: it is the last one.
    std::span<std::uint32_t const> next_assemblies() const { return next_assembly_; }

    /// Whether the body is in an active island.
    bool has_contact(std::uint32_t body) const { return is_active_[island_[parent_[body]]] != 0; }

private:
    static constexpr std::uint32_t kNoIsland = 0;

    /// A contact whose gap is less than the reach.
    struct Close {
        std::uint32_t contact;  // into NearContacts::near()
        bool meets;             // they touch within this step
    };

    static void find_pairs(World const& world, NearContacts const& contacts, Reach const& reach, WorkRange pairs,
                           std::vector<Close>& found);
    static void find_fixed(World const& world, NearContacts const& contacts, Reach const& reach, WorkRange fixed,
                           std::vector<Close>& found);
    static void find_hulls(World const& world, NearContacts const& contacts, Reach const& reach, WorkRange hulls,
                           std::vector<Close>& found);
    void unite(NearContacts const& contacts);
    void link(NearContacts const& contacts);
    void link_assemblies(World const& world, Assemblies const& assemblies, Reach const& reach);

    std::vector<std::uint32_t> parent_;      // for each body, in the disjoint-set forest; after the search, its root
    std::vector<std::uint32_t> island_;      // for each root, into islands_; kNoIsland: none
    std::vector<std::vector<Close>> close_;  // for each range of contacts, during the search
    std::vector<IslandContact> contacts_;    // in the order of NearContacts::near()
    std::vector<std::uint8_t> meets_;        // for each link: its bodies touch within this step
    std::vector<std::uint32_t> next_assembly_;
    std::vector<Island> islands_{{}};      // behind kNoIsland, which is empty and never active
    std::vector<std::uint8_t> is_active_;  // of each island: fewer bytes, as neighbours in memory are not in one place
};

}  // namespace pogosim
