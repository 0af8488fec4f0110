// The contacts that disks can make in the coming steps, with other disks, obstacles and walls.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "physics/fixed_polygons.hpp"
#include "physics/membrane_filter.hpp"
#include "physics/neighbour_list.hpp"
#include "physics/soft_membranes.hpp"
#include "physics/wall_neighbour_list.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Overlaps up to this, in mm, are left as they are; they count as no contact.
inline constexpr float kContactToleranceMm = 0.05F;

/// Constants of a contact.
struct ContactLaw {
    float radius_mm;    // sum of the two radii
    float normal_mass;  // impulse that changes the speed of separation by 1 mm/s
    float inverse_normal_mass;
    float tangent_mass;  // the same for the slip, with the disks' turning
    float friction;      // Coulomb coefficient
    float restitution;   // 0 to 1
};

/// A movable disk and the thing that it may touch.
struct NearContact {
    std::uint32_t a;
    std::uint32_t b;  // another movable disk, a fixed body, or an edge of a wall: see DiskContacts
    ContactLaw law;
};

/// Constants of a body, for the whole run.
struct Disk {
    float radius_mm;        // 0 for a polygon
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

class DiskContacts {
public:
    DiskContacts(World const& world, WallSpec const& walls);

    /// Builds the contacts from the neighbour lists.
    void build(World const& world, NeighbourList const& pairs, WallNeighbourList const& walls);

    /// First pairs of movable disks, then disks with fixed bodies, then disks with walls.
    std::vector<NearContact> const& near() const { return near_; }

    /// Number of pairs of movable disks.
    std::uint32_t pair_count() const { return pair_count_; }

    /// Impulse of each contact at the last step in which motors drove it, 0 for a new one: the initial guess for the
    /// next such step.
    std::vector<float>& driven_impulse() { return driven_impulse_; }

    /// The same for each joint of the world, which is a spring.
    std::vector<SpringImpulse>& spring_impulse() { return spring_impulse_; }
    std::vector<SpringImpulse> const& spring_impulse() const { return spring_impulse_; }

    FixedPolygons const& polygons() const { return polygons_; }

    Disk const& disk(std::uint32_t body) const { return disks_[body]; }

    /// Gap between a point and the fixed thing of a contact (index pair_count() or above). None if they cannot touch,
    /// see gap_to().
    std::optional<Gap> gap_to_fixed(World const& world, std::uint32_t contact, Vec2 point_mm) const;

private:
    bool is_fixed(std::uint32_t body) const { return disks_[body].inverse_mass == 0.0F; }

    /// A contact with an impulse, identified by its two things.
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
    std::vector<NearContact> with_fixed_;  // scratch, while near_ is rebuilt
    std::vector<float> driven_impulse_;
    std::vector<SpringImpulse> spring_impulse_;
    std::vector<Pushing> pushing_;  // scratch, while near_ is rebuilt
    std::uint32_t pair_count_ = 0;
    std::uint32_t first_wall_ = 0;  // in near_
    std::shared_ptr<WallSides const> walls_;
};

}  // namespace pogosim
