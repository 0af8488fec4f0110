// Power diagram of weighted sites: each point belongs to the site of least squared distance less weight. With equal
// weights it is the Voronoi diagram. F. Aurenhammer, "Power diagrams: properties, algorithms and applications", SIAM J.
// Comput. 16(1), 78-96, 1987.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/grid.hpp"
#include "geometry/formations/disk_field.hpp"

namespace pogosim {

class PowerDiagram {
public:
    /// A site's weight is its radius squared, so that the border of two touching disks runs through their contact.
    PowerDiagram(Box bounds_mm, std::span<float const> radii_mm);

    void set_sites(std::span<Vec2 const> sites_mm);

    /// The site whose cell the point, within the bounds, is in. The first of equals.
    std::uint32_t cell_of(Vec2 point_mm) const;

private:
    struct Layer {
        SizeClass sizes;
        UniformGrid grid;  // of the members
    };

    Box bounds_mm_;
    std::vector<Layer> layers_;
    std::vector<float> weights_;
};

}  // namespace pogosim
