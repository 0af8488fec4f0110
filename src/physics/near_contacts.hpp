// The contacts that bodies can make in the coming steps, with others, obstacles and walls.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "physics/assemblies.hpp"
#include "physics/hulls.hpp"
#include "physics/membrane_filter.hpp"
#include "physics/neighbour_list.hpp"
#include "physics/soft_membranes.hpp"
#include "physics/substep.hpp"
#include "physics/wall_neighbour_list.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Impulses of the two touches of a hull.
struct HullImpulse {
    struct Part {
        float normal = 0.0F;
        float tangent = 0.0F;
        std::uint32_t features = 0;  // see ManifoldPoint
    };
    std::array<Part, 2> parts;
};

/// The parts of the two bodies of a contact, see Hulls; 0 unless they are compounds.
struct TouchingParts {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
};

/// Constants of a contact. The masses are those of disks.
struct ContactLaw {
    float radius_mm;    // sum of the two radii
    float normal_mass;  // impulse that changes the speed of separation by 1 mm/s
    float inverse_normal_mass;
    float tangent_mass;  // the same for the slip, with the disks' turning
    float friction;      // Coulomb coefficient
    float restitution;   // 0 to 1
};

/// A movable body and the thing that it may touch.
struct NearContact {
    std::uint32_t a;
    std::uint32_t b;  // another movable body, a fixed one, or an edge of a wall: see NearContacts
    ContactLaw law;
};

/// Constants of a body, for the whole run.
struct Disk {
    float radius_mm;        // 0 for a fixed polygon
    float inverse_mass;     // 0: fixed
    float inverse_inertia;  // 1 / (mass mm^2)
    float friction;
    float restitution;
};

/// Gap between a point, at `way` from the centre of a disk, and that disk. Coinciding centres are separated along x.
inline Gap gap_to_centre(Vec2 way) {
    float const distance_mm = length(way);
    return {distance_mm, distance_mm > 0.0F ? (1.0F / distance_mm) * way : Vec2{1.0F, 0.0F}};
}

class NearContacts {
public:
    /// `sides`: of all walls, see WallNeighbourList::sides().
    NearContacts(World const& world, WallSpec const& walls, std::shared_ptr<WallSides const> sides);

    /// Builds the contacts from the neighbour lists.
    void build(World const& world, Assemblies const& assemblies, NeighbourList const& pairs,
               WallNeighbourList const& walls);

    /// First pairs of movable disks, then disks with fixed bodies, then disks with walls. Then the contacts in which a
    /// movable body is a hull, in the same order.
    std::vector<NearContact> const& near() const { return near_; }

    /// Number of pairs of movable disks.
    std::uint32_t pair_count() const { return pair_count_; }

    /// The first contact of a movable hull.
    std::uint32_t first_hull() const { return first_hull_; }

    /// Both bodies can move.
    bool is_pair(std::uint32_t contact) const {
        return contact < pair_count_ || (contact >= first_hull_ && contact < first_hull_fixed_);
    }
    bool is_wall(std::uint32_t contact) const {
        return contact < first_hull_ ? contact >= first_wall_ : contact >= first_hull_wall_;
    }
    WallSide const& wall_side(std::uint32_t contact) const { return (*sides_)[near_[contact].b]; }

    /// Impulse of each contact at the last step in which motors drove it, 0 for a new one: the initial guess for the
    /// next such step.
    std::vector<float>& driven_impulse() { return driven_impulse_; }

    /// The same for contacts of hulls, from first_hull() on.
    std::vector<HullImpulse>& hull_impulse() { return hull_impulse_; }

    /// The same for each joint of the world that is a spring.
    std::vector<SpringImpulse>& spring_impulse() { return spring_impulse_; }
    std::vector<SpringImpulse> const& spring_impulse() const { return spring_impulse_; }

    /// The parts of the bodies of a contact of hulls: each contact is between two of them.
    TouchingParts const& parts(std::uint32_t contact) const { return hull_parts_[contact - first_hull_]; }

    Hulls const& hulls() const { return hulls_; }

    Disk const& disk(std::uint32_t body) const { return disks_[body]; }

    /// Gap between a point and the fixed thing of a contact (index pair_count() or above). None if they cannot touch,
    /// see gap_to().
    std::optional<Gap> gap_to_fixed(World const& world, std::uint32_t contact, Vec2 point_mm) const;

    /// The gap of a contact of a hull if it is below `beyond_mm`, else at least that; to a wall, at most the gap.
    float gap_of_hull_mm(World const& world, std::uint32_t contact, float beyond_mm) const;

    /// What later steps depend on, see state_bytes.hpp.
    template <class Self, class State>
    static void visit_state(Self& self, State& state) {
        state(self.near_, self.fixed_part_, self.hull_parts_, self.driven_impulse_, self.hull_impulse_,
              self.spring_impulse_, self.pair_count_, self.first_wall_, self.first_hull_, self.first_hull_fixed_,
              self.first_hull_wall_);
    }

private:
    bool is_fixed(std::uint32_t body) const { return disks_[body].inverse_mass == 0.0F; }

    bool is_movable_hull(std::uint32_t body) const { return !is_fixed(body) && hulls_.is_one(body); }

    /// A contact with an impulse, identified by its two things.
    struct Pushing {
        std::uint64_t things;
        std::uint32_t parts;
        float impulse;
        HullImpulse of_hull;

        std::pair<std::uint64_t, std::uint32_t> name() const { return {things, parts}; }
    };

    bool may_collide(Assemblies const& assemblies, std::uint32_t a, std::uint32_t b) const {
        return membranes_.may_collide(a, b) && assemblies.may_collide(a, b);
    }
    void add_hulls(Assemblies const& assemblies, NeighbourList const& pairs, WallNeighbourList const& walls);
    void add_fixed(World const& world, std::uint32_t disk, std::uint32_t fixed, float skin_mm);
    Pushing named(std::uint32_t contact) const;
    void keep_impulses();
    void give_impulses();

    MembraneFilter membranes_;
    Hulls hulls_;
    std::vector<Disk> disks_;
    Disk wall_;
    std::vector<NearContact> near_;
    std::vector<std::uint32_t> fixed_part_;  // of each contact of a disk with a fixed body
    std::vector<TouchingParts> hull_parts_;  // of each contact of a movable hull
    std::vector<NearContact> with_fixed_;    // scratch, while near_ is rebuilt
    std::vector<float> driven_impulse_;
    std::vector<HullImpulse> hull_impulse_;
    std::vector<SpringImpulse> spring_impulse_;
    std::vector<TouchingParts> parts_with_fixed_;  // scratch, while near_ is rebuilt
    std::vector<Pushing> pushing_;                 // scratch, while near_ is rebuilt
    std::vector<std::uint8_t> pushes_;             // of each body: it has a contact in pushing_
    std::uint32_t pair_count_ = 0;
    std::uint32_t first_wall_ = 0;  // in near_
    std::uint32_t first_hull_ = 0;
    std::uint32_t first_hull_fixed_ = 0;
    std::uint32_t first_hull_wall_ = 0;
    std::shared_ptr<WallSides const> sides_;
};

}  // namespace pogosim
