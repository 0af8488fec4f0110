// Bodies that go so far in one step that they could jump over others.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/grid.hpp"
#include "physics/fixed_polygons.hpp"
#include "physics/known_motion.hpp"
#include "world/world.hpp"

namespace pogosim {

class Sweep {
public:
    explicit Sweep(World const& world);

    /// Stops disks where they meet others on their ways through the step, from where they were `before` it; the next
    /// step makes the impact. Looks at the ways of `fast` bodies, which go further than others, and of all that meet
    /// one of those that have been stopped. Returns the bodies whose way was cut, some of them perhaps twice.
    /// Two that overlap at the start come no nearer to each other. Bodies of membranes do not stop each other.
    std::vector<std::uint32_t> const& stop_at_impacts(World& world, FixedPolygons const& polygons,
                                                      std::span<std::uint32_t const> fast, KnownMotion const& before);

private:
    void find_ways(World const& world, std::span<std::uint32_t const> fast, KnownMotion const& before);
    float reach_mm(Bodies const& bodies, std::uint32_t i) const;
    float free_fraction(World const& world, FixedPolygons const& polygons, std::uint32_t i) const;
    float fraction_before(World const& world, std::uint32_t i, std::uint32_t k) const;
    void look_at_again(World const& world, std::uint32_t i);

    std::vector<char> is_of_membrane_;  // all bodies
    std::vector<Vec2> starts_mm_;       // of all bodies
    std::vector<Vec2> motions_mm_;      // of all, to where they are now
    std::vector<float> fractions_;      // of its motion that each makes
    std::vector<std::uint32_t> waiting_;
    std::vector<char> is_waiting_;  // of all bodies
    std::vector<int> cuts_;         // of the way of each body
    std::vector<std::uint32_t> stopped_;
    UniformGrid grid_;  // of the starts
    float farthest_mm_ = 0.0F;
    float largest_mm_ = 0.0F;
};

}  // namespace pogosim
