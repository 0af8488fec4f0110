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

class WallIndex {
public:
    explicit WallIndex(Arena const& arena);

    /// Distance from the point to the nearest wall, mm; `most_mm` when there is none so near.
    float distance(Vec2 point_mm, float most_mm) const;

    /// The first touch of a disk of `radius_mm` whose centre moves from `from_mm` by `motion_mm`. A wall that is nearer
    /// than the radius at the start is touched at once when the centre approaches it, and not at all when it does not.
    std::optional<WallTouch> first_touch(Vec2 from_mm, Vec2 motion_mm, float radius_mm) const;

private:
    /// An edge of a polygon, with free space on its right when it is walked along on the screen (y down).
    struct Edge {
        Vec2 from;
        Vec2 to;
    };

    struct Cells {
        int first_column;
        int last_column;
        int first_row;
        int last_row;
    };

    template <class Visit>
    void for_each_cell(Edge const& edge, Visit const& visit) const;
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
    std::vector<Edge> edges_;           // by cell; one that crosses several cells stands in each
};

}  // namespace pogosim
