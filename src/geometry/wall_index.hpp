// The walls of an arena sorted by place: which is near a point, and which one a moving disk meets first.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/arena.hpp"

namespace pogosim {

/// Where a moving disk touches a wall.
struct WallTouch {
    double fraction = 0.0;  // of its motion, 0 to 1
    Vec2 normal;            // unit vector from the wall to the disk's centre
};

/// An edge of a polygon, with free space on its right when it is walked along on the screen (y down).
struct WallEdge {
    Vec2 from;
    Vec2 to;
    std::uint32_t number = 0;    // along the walls of the arena
    std::uint32_t previous = 0;  // number of the edge that ends at `from`
};

class WallIndex {
public:
    explicit WallIndex(Arena const& arena);

    /// Every edge of the arena, by number.
    std::vector<WallEdge> const& edges() const { return all_; }

    /// Calls visit(edge) for all edges within the radius of a point, and some others, some more than once.
    template <class Visit>
    void for_each_near(Vec2 point_mm, float radius_mm, Visit const& visit) const {
        Vec2 const reach{radius_mm, radius_mm};
        for_each_edge({point_mm - reach, point_mm + reach}, visit);
    }

    /// Distance from the point to the nearest wall, mm; `most_mm` when there is none so near.
    float distance(Vec2 point_mm, float most_mm) const;

    /// The first touch of a disk of `radius_mm` whose centre moves from `from_mm` by `motion_mm`. A wall that is nearer
    /// than the radius at the start is touched at once when the centre approaches it, and not at all when it does not.
    std::optional<WallTouch> first_touch(Vec2 from_mm, Vec2 motion_mm, float radius_mm) const;

private:
    struct Cells {
        int first_column;
        int last_column;
        int first_row;
        int last_row;
    };

    template <class Visit>
    void for_each_cell(WallEdge const& edge, Visit const& visit) const;
    template <class Visit>
    void for_each_edge(Box const& box, Visit const& visit) const;
    Cells cells_of(Box const& box) const;
    int column_of(float x_mm) const;
    int row_of(float y_mm) const;

    Vec2 origin_mm_;
    float cell_mm_ = 1.0F;
    int columns_ = 1;
    int rows_ = 1;
    std::vector<std::uint32_t> start_;  // of each cell in edges_, one more at the end
    std::vector<WallEdge> edges_;       // by cell; one that crosses several cells stands in each
    std::vector<WallEdge> all_;
};

template <class Visit>
void WallIndex::for_each_edge(Box const& box, Visit const& visit) const {
    Cells const cells = cells_of(box);
    for (int row = cells.first_row; row <= cells.last_row; ++row) {
        // The cells of a row follow each other.
        std::size_t const row_start = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_);
        std::uint32_t const first = start_[row_start + static_cast<std::size_t>(cells.first_column)];
        std::uint32_t const last = start_[row_start + static_cast<std::size_t>(cells.last_column) + 1];
        for (std::uint32_t k = first; k < last; ++k) {
            visit(edges_[k]);
        }
    }
}

}  // namespace pogosim
