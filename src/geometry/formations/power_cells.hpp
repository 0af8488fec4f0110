// Which of many points are in the cell of which site of a power diagram, summed up by cells.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec2.hpp"

namespace pogosim {

/// Points, added up.
struct PointSum {
    double x_mm = 0.0;
    double y_mm = 0.0;
    std::size_t count = 0;

    void add(PointSum const& other) {
        x_mm += other.x_mm;
        y_mm += other.y_mm;
        count += other.count;
    }
};

/// Power diagram of weighted sites: each point belongs to the site of least squared distance less weight, the first of
/// equals. With equal weights it is the Voronoi diagram. F. Aurenhammer, "Power diagrams: properties, algorithms and
/// applications", SIAM J. Comput. 16(1), 78-96, 1987.
///
/// The points are sorted into a quadtree, once. Each part of it keeps the sites that can be the nearest of any point in
/// it; if there is one, all of its points are counted at once. T. Kanungo et al., "An efficient k-means clustering
/// algorithm: analysis and implementation", IEEE Trans. Pattern Anal. Mach. Intell. 24(7), 881-892, 2002.
class PowerCells {
public:
    /// `points`: within the bounds.
    PowerCells(Box const& bounds_mm, std::span<Vec2 const> points_mm);

    /// The points of the cell of each site. `weights_mm2`: one for each site.
    std::vector<PointSum> sums(std::span<Vec2 const> sites_mm, std::span<float const> weights_mm2) const;

private:
    struct Node {
        std::uint32_t first = 0;  // of its points
        std::uint32_t end = 0;
        PointSum sum;
    };
    struct Search;

    /// Looks at a part of the tree, for which the candidates are those from `first_candidate` to `end_candidate`.
    void visit(Search& search, int level, std::uint32_t place, Box const& box_mm, std::size_t first_candidate,
               std::size_t end_candidate) const;
    std::vector<Node> const& level(int number) const { return levels_[static_cast<std::size_t>(number)]; }

    Box bounds_mm_;
    std::vector<Vec2> points_mm_;            // in the order of the leaves
    std::vector<std::vector<Node>> levels_;  // the root; its four parts; theirs, ... in Morton order
};

}  // namespace pogosim
