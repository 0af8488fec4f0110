#include "geometry/formations/power_diagram.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace pogosim {

PowerDiagram::PowerDiagram(Box bounds_mm, std::span<float const> radii_mm) : bounds_mm_(bounds_mm) {
    for (float const radius : radii_mm) {
        weights_.push_back(radius * radius);
    }
    for (SizeClass& sizes : size_classes(radii_mm)) {
        layers_.push_back({std::move(sizes), UniformGrid()});
    }
}

void PowerDiagram::set_sites(std::span<Vec2 const> sites_mm) {
    for (Layer& layer : layers_) {
        std::vector<Vec2> members_mm;
        for (std::uint32_t const site : layer.sizes.members) {
            members_mm.push_back(sites_mm[site]);
        }
        layer.grid.build(members_mm, bounds_mm_, spacing_mm(bounds_mm_, members_mm.size()), /*periodic=*/false);
    }
}

std::uint32_t PowerDiagram::cell_of(Vec2 point_mm) const {
    std::pair<float, std::uint32_t> best{std::numeric_limits<float>::infinity(), 0};  // power, site
    for (Layer const& layer : layers_) {
        float const largest_weight = layer.sizes.largest * layer.sizes.largest;
        layer.grid.search_outwards(
            point_mm,
            [&](std::uint32_t member, Vec2 place) {
                std::uint32_t const site = layer.sizes.members[member];
                best = std::min(best, {squared_length(place - point_mm) - weights_[site], site});
            },
            [&](float gap_mm) { return gap_mm * gap_mm - largest_weight > best.first; });
    }
    return best.second;
}

}  // namespace pogosim
