#include "geometry/formations/disk_field.hpp"

#include <cmath>
#include <map>

namespace pogosim {

std::vector<SizeClass> size_classes(std::span<float const> sizes) {
    std::map<int, SizeClass> by_exponent;
    for (std::uint32_t i = 0; i < sizes.size(); ++i) {
        SizeClass& own = by_exponent[std::ilogb(sizes[i])];
        own.members.push_back(i);
        own.largest = std::max(own.largest, sizes[i]);
    }
    std::vector<SizeClass> classes;
    classes.reserve(by_exponent.size());
    for (auto& [exponent, own] : by_exponent) {
        classes.push_back(std::move(own));
    }
    return classes;
}

float spacing_mm(Box bounds_mm, std::size_t count) {
    Vec2 const size = bounds_mm.size();
    return std::sqrt(size.x * size.y / static_cast<float>(count + 1));
}

DiskField::DiskField(Box bounds_mm, std::span<float const> radii_mm) : radii_(radii_mm), layer_of_(radii_mm.size()) {
    for (SizeClass const& own : size_classes(radii_mm)) {
        for (std::uint32_t const member : own.members) {
            layer_of_[member] = static_cast<std::uint32_t>(layers_.size());
        }
        float const cell_mm = std::max(2.0F * own.largest, spacing_mm(bounds_mm, radii_mm.size()));
        layers_.push_back({GrowingGrid(bounds_mm, cell_mm, radii_mm.size()), own.largest});
    }
}

void DiskField::clear() {
    for (Layer& layer : layers_) {
        layer.grid.clear();
    }
}

void DiskField::put(std::uint32_t index, Vec2 centre_mm) {
    layers_[layer_of_[index]].grid.insert(index, centre_mm);
}

bool DiskField::is_free(Vec2 centre_mm, float radius_mm) const {
    return !any_near(centre_mm, radius_mm, [&](std::uint32_t other, Vec2 centre) {
        float const apart_mm = radius_mm + radii_[other];
        return squared_length(centre - centre_mm) < apart_mm * apart_mm;
    });
}

}  // namespace pogosim
