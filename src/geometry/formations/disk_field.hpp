// Disks of many sizes that have been put down, to find those that a new one would overlap.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "base/grid.hpp"

namespace pogosim {

/// Objects whose sizes differ by less than a factor of two; searching each class with its own cell size keeps one large
/// object from slowing down the search among thousands of small ones.
struct SizeClass {
    std::vector<std::uint32_t> members;
    float largest = 0.0F;
};

/// All objects by the binary exponent of their size, smallest class first.
std::vector<SizeClass> size_classes(std::span<float const> sizes);

/// Mean distance between so many points in a box.
float spacing_mm(Box bounds_mm, std::size_t count);

class DiskField {
public:
    /// Room for the disks of these radii, none of which has been put down. `radii_mm` must outlive the field.
    DiskField(Box bounds_mm, std::span<float const> radii_mm);

    void clear();

    /// Puts down disk `index`.
    void put(std::uint32_t index, Vec2 centre_mm);

    /// True when match(index, centre) holds for some disk; asks for all those that come within `reach_mm` of the point,
    /// and some more.
    template <typename Match>
    bool any_near(Vec2 point_mm, float reach_mm, Match match) const {
        return std::ranges::any_of(layers_, [&](Layer const& layer) {
            return layer.grid.any_near(point_mm, reach_mm + layer.largest_mm, match);
        });
    }

    /// True when a disk here would overlap none of those put down.
    bool is_free(Vec2 centre_mm, float radius_mm) const;

private:
    struct Layer {
        GrowingGrid grid;
        float largest_mm;
    };

    std::span<float const> radii_;
    std::vector<Layer> layers_;
    std::vector<std::uint32_t> layer_of_;  // of each disk
};

}  // namespace pogosim
