#include "geometry/formations/power_diagram.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace pogosim {

PowerDiagram::PowerDiagram(Box bounds_mm, std::span<float const> radii_mm) {
    for (float const radius : radii_mm) {
        weights_.push_back(radius * radius);
    }
    for (SizeClass& sizes : size_classes(radii_mm)) {
        layers_.push_back({std::move(sizes), PointGrid(bounds_mm, 0.0F, radii_mm.size())});
    }
}

void PowerDiagram::set_sites(std::span<Vec2 const> sites_mm) {
    for (Layer& layer : layers_) {
        layer.grid.clear();
        for (std::uint32_t const site : layer.sizes.members) {
            layer.grid.insert(site, sites_mm[site]);
        }
    }
}

std::uint32_t PowerDiagram::cell_of(Vec2 point_mm) const {
    std::pair<float, std::uint32_t> best{std::numeric_limits<float>::infinity(), 0};  // power, site
    for (Layer const& layer : layers_) {
        float const largest_weight = layer.sizes.largest * layer.sizes.largest;
        layer.grid.search_outwards(
            point_mm,
            [&](std::uint32_t site, Vec2 place) {
                best = std::min(best, {squared_length(place - point_mm) - weights_[site], site});
            },
            [&](float gap_mm) { return gap_mm * gap_mm - largest_weight > best.first; });
    }
    return best.second;
}

}  // namespace pogosim
