// Points sorted into square cells, rebuilt each time: finds neighbours in time proportional to their number.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec2.hpp"

namespace pogosim {

class UniformGrid {
public:
    /// Sorts the points (mm). `cell_mm` is about the radius of the queries to come; `periodic` wraps at `bounds`, else
    /// points outside of them count as in the outermost cell.
    void build(std::span<Vec2 const> points, Box bounds, float cell_mm, bool periodic);

    /// Calls visit(index, point) for every point of the cells that touch the square of half width `radius_mm` around
    /// the centre: all points within the radius, and some others. Always in the same order.
    template <class Visit>
    void for_each_near(Vec2 centre, float radius_mm, Visit const& visit) const;

private:
    /// A copy of the point next to its index, so that queries read memory sequentially.
    struct Item {
        Vec2 point;
        std::uint32_t index;
    };

    struct Span {
        int first;
        int last;
    };

    int column_of(float x) const { return cell_at((x - origin_.x) * columns_per_mm_, columns_); }
    int row_of(float y) const { return cell_at((y - origin_.y) * rows_per_mm_, rows_); }
    int cell_at(float position, int count) const {
        auto const whole = static_cast<float>(count);
        return clamp_cell(periodic_ ? position - whole * std::floor(position / whole) : position, count);
    }
    static int clamp_cell(float position, int count) {
        return static_cast<int>(std::clamp(position, 0.0F, static_cast<float>(count - 1)));
    }

    /// Of cells that may lie beyond the bounds on either side.
    static int remainder(int cell, int count) {
        int const rest = cell % count;
        return rest < 0 ? rest + count : rest;
    }

    /// Cells along one axis that a query touches. May lie outside [0, count) when periodic, and is never longer than
    /// count.
    static Span cells(float low, float high, int count, bool periodic);

    Vec2 origin_;
    float columns_per_mm_ = 1.0F;
    float rows_per_mm_ = 1.0F;
    int columns_ = 1;
    int rows_ = 1;
    bool periodic_ = false;
    std::vector<std::uint32_t> start_;  // of each cell in items_, one more at the end
    std::vector<Item> items_;           // by cell
    std::vector<std::uint32_t> cell_;   // of each point
};

template <class Visit>
void UniformGrid::for_each_near(Vec2 centre, float radius_mm, Visit const& visit) const {
    Vec2 const low = centre - origin_ - Vec2{radius_mm, radius_mm};
    Vec2 const high = centre - origin_ + Vec2{radius_mm, radius_mm};
    Span const columns = cells(low.x * columns_per_mm_, high.x * columns_per_mm_, columns_, periodic_);
    Span const rows = cells(low.y * rows_per_mm_, high.y * rows_per_mm_, rows_, periodic_);
    for (int r = rows.first; r <= rows.last; ++r) {
        int const row = remainder(r, rows_);
        for (int c = columns.first; c <= columns.last; ++c) {
            int const column = remainder(c, columns_);
            auto const cell =
                static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
            for (std::uint32_t k = start_[cell]; k < start_[cell + 1]; ++k) {
                visit(items_[k].index, items_[k].point);
            }
        }
    }
}

}  // namespace pogosim
