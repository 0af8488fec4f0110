// What disks can touch in the steps to come, and how: other disks and walls.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "physics/fixed_polygons.hpp"
#include "physics/membrane_filter.hpp"
#include "physics/near_pairs.hpp"
#include "physics/near_walls.hpp"
#include "physics/soft_membranes.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Smaller overlaps, mm, may stay: who overlaps by less does not touch.
inline constexpr float kContactToleranceMm = 0.05F;

/// What two things are to each other when they touch.
struct ContactLaw {
    float radius_mm;    // the sum of both
    float normal_mass;  // impulse that changes the speed of separation by 1 mm/s
    float inverse_normal_mass;
    float tangent_mass;  // the same for the slip, with the disks' turning
    float friction;      // Coulomb coefficient
    float restitution;   // 0 to 1
};

/// A disk that moves and what it may touch.
struct NearContact {
    std::uint32_t a;
    std::uint32_t b;  // another disk that moves, a fixed body, or an edge of a wall: see DiskContacts
    ContactLaw law;
};

/// What a body is to the contacts, for the whole run.
struct Disk {
    float radius_mm;        // 0 for a polygon
    float inverse_mass;     // 0: fixed
    float inverse_inertia;  // 1 / (mass mm^2)
    float friction;
    float restitution;
};

/// Of a point, `way` from the centre of a disk. Disks at the same place are parted along x.
inline Gap gap_to_centre(Vec2 way) {
    float const distance_mm = length(way);
    return {distance_mm, distance_mm > 0.0F ? (1.0F / distance_mm) * way : Vec2{1.0F, 0.0F}};
}

class DiskContacts {
public:
    DiskContacts(World const& world, WallSpec const& walls);

    /// Takes over what is near. The walls are used later, too.
    void build(World const& world, NearPairs const& pairs, NearWalls const& walls);

    /// Pairs of disks that move, then disks with fixed bodies, then disks with walls.
    std::vector<NearContact> const& near() const { return near_; }

    /// Number of pairs of disks that move.
    std::uint32_t pair_count() const { return pair_count_; }

    /// Impulse of each contact when motors drove it last, 0 if it is new: a first guess for the next time.
    std::vector<float>& driven_impulse() { return driven_impulse_; }

    /// The same of each joint of the world, a spring.
    std::vector<SpringImpulse>& spring_impulse() { return spring_impulse_; }
    std::vector<SpringImpulse> const& spring_impulse() const { return spring_impulse_; }

    FixedPolygons const& polygons() const { return polygons_; }

    Disk const& disk(std::uint32_t body) const { return disks_[body]; }

    /// How far the fixed thing of a contact, pair_count() or later, is from a point. Nothing if it has nothing to do
    /// with it, see gap_to().
    std::optional<Gap> gap_to_fixed(World const& world, std::uint32_t contact, Vec2 point_mm) const;

private:
    bool is_fixed(std::uint32_t body) const { return disks_[body].inverse_mass == 0.0F; }

    /// A contact that pushes, by its things.
    struct Pushing {
        std::uint64_t things;
        float impulse;
    };

    void add_fixed(World const& world, std::uint32_t disk, std::uint32_t fixed, float skin_mm);
    std::uint64_t things_of(std::uint32_t contact) const;
    void keep_impulses();
    void give_impulses();

    MembraneFilter membranes_;
    FixedPolygons polygons_;
    std::vector<Disk> disks_;
    Disk wall_;
    std::vector<NearContact> near_;
    std::vector<NearContact> with_fixed_;  // while near_ is built anew
    std::vector<float> driven_impulse_;
    std::vector<SpringImpulse> spring_impulse_;
    std::vector<Pushing> pushing_;  // while near_ is built anew
    std::uint32_t pair_count_ = 0;
    std::uint32_t first_wall_ = 0;  // in near_
    NearWalls const* walls_ = nullptr;
};

}  // namespace pogosim
