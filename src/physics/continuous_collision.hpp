// Continuous collision detection: keeps fast bodies from passing through others within one step.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/grid.hpp"
#include "physics/assemblies.hpp"
#include "physics/hulls.hpp"
#include "world/world.hpp"

namespace pogosim {

class ContinuousCollision {
public:
    explicit ContinuousCollision(World const& world);

    /// Stops bodies where they first touch others on their straight paths from the start to the end of the step; the
    /// impact itself happens in the next step. Tests the paths of the `fast` bodies, and of all bodies that meet one
    /// that has been stopped. Returns the bodies whose motion was shortened; some may be listed twice. Two bodies that
    /// overlap at the start do not approach further. Bodies of membranes do not stop each other, nor do those with a
    /// hinge between them.
    std::vector<std::uint32_t> const& stop_at_impacts(World& world, Hulls const& hulls, Assemblies const& assemblies,
                                                      std::span<std::uint32_t const> fast);

private:
    struct PartOf {
        std::uint32_t body;
        std::uint32_t part;
    };

    void find_ways(World const& world, std::span<std::uint32_t const> fast);
    float reach_mm(Bodies const& bodies, std::uint32_t i) const;
    bool can_stop(Assemblies const& assemblies, std::uint32_t i, std::uint32_t k) const;
    float free_fraction(World const& world, Hulls const& hulls, Assemblies const& assemblies, std::uint32_t i) const;
    float fraction_before(World const& world, std::uint32_t i, std::uint32_t k) const;
    float fraction_before_hull(World const& world, Hulls const& hulls, std::uint32_t i, std::uint32_t k) const;
    float fraction_before_part(World const& world, Hulls const& hulls, PartOf const& own, PartOf const& other) const;
    Hull hull_at(World const& world, Hulls const& hulls, PartOf const& part, float fraction, Vec2 origin_mm) const;
    void look_at_again(World const& world, std::uint32_t i);

    std::vector<char> is_of_membrane_;  // all bodies
    std::vector<Vec2> starts_mm_;       // of all bodies
    std::vector<Vec2> motions_mm_;      // of all bodies, from start to end of the step
    std::vector<float> turns_rad_;      // the same
    std::vector<float> fractions_;      // of its motion that each body makes
    std::vector<std::uint32_t> waiting_;
    std::vector<char> is_waiting_;  // of all bodies
    std::vector<int> cuts_;         // how often the motion of each body was shortened
    std::vector<std::uint32_t> stopped_;
    UniformGrid grid_;  // of starts_mm_
    float farthest_mm_ = 0.0F;
    float largest_mm_ = 0.0F;
};

}  // namespace pogosim
