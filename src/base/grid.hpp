// Points sorted into the cells of a grid, to find neighbours in time proportional to their number: UniformGrid sorts
// all of them at once, which makes the fastest searches, and GrowingGrid takes them one by one.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/vec2.hpp"

namespace pogosim {

/// Equal cells over a box. Points beyond it are in the outermost cells, or, if `periodic`, wrapped into it.
class GridCells {
public:
    GridCells() = default;
    /// Cells are at least `smallest_cell_mm` wide where the box is not narrower, and not many more than `point_count`.
    GridCells(Box bounds, float smallest_cell_mm, std::size_t point_count, bool periodic);

    std::size_t size() const { return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_); }

    std::size_t cell_of(Vec2 point) const { return index(column_of(point.x), row_of(point.y)); }

    /// Calls is_found(cell) for the cells that touch the square of half width `radius_mm` around the centre, row by
    /// row, until it returns true. Returns whether it has.
    template <class Found>
    bool any_near(Vec2 centre, float radius_mm, Found const& is_found) const;

    /// The same with is_found(first, last) for runs of adjacent cells of a row, both ends included.
    template <class Found>
    bool any_run_near(Vec2 centre, float radius_mm, Found const& is_found) const;

private:
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
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
    }

    /// A range of columns or rows that may extend beyond the bounds on either side.
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
};

class UniformGrid {
public:
    /// Sorts the points (mm). `cell_mm`: about the radius of the coming queries; `periodic` wraps at `bounds`, else
    /// points outside of them count as in the outermost cell.
    void build(std::span<Vec2 const> points, Box bounds, float cell_mm, bool periodic);

    /// Calls visit(index, point) for every point of the cells that touch the square of half width `radius_mm` around
    /// the centre: all points within the radius, and some others. Always in the same order.
    template <class Visit>
    void for_each_near(Vec2 centre, float radius_mm, Visit const& visit) const {
        cells_.any_near(centre, radius_mm, [&](std::size_t cell) {
            visit_cell(cell, visit);
            return false;
        });
    }

private:
    /// A copy of the point next to its index, so that queries read memory sequentially.
    struct Item {
        Vec2 point;
        std::uint32_t index;
    };

    template <class Visit>
    void visit_cell(std::size_t cell, Visit const& visit) const {
        for (std::uint32_t k = start_[cell]; k < start_[cell + 1]; ++k) {
            visit(items_[k].index, items_[k].point);
        }
    }

    GridCells cells_;
    std::vector<std::uint32_t> start_;  // of each cell in items_, and the end
    std::vector<Item> items_;           // by cell
    std::vector<std::uint32_t> cell_;   // of each point
};

class GrowingGrid {
public:
    /// Empty, with room for `point_count` points.
    GrowingGrid(Box bounds, float cell_mm, std::size_t point_count)
        : cells_(bounds, cell_mm, point_count, /*periodic=*/false), points_(point_count), next_(point_count, kEnd) {
        clear();
    }

    void clear() { heads_.assign(cells_.size(), kEnd); }

    /// Adds a point under an unused number below the point count.
    void insert(std::uint32_t index, Vec2 point) {
        std::uint32_t& head = heads_[cells_.cell_of(point)];
        points_[index] = point;
        next_[index] = head;
        head = index;
    }

    /// True if match(index, point) holds for any point; tests all points within the radius, and some others.
    template <class Match>
    bool any_near(Vec2 centre, float radius_mm, Match const& match) const {
        return cells_.any_near(centre, radius_mm, [&](std::size_t cell) {
            for (std::uint32_t i = heads_[cell]; i != kEnd; i = next_[i]) {
                if (match(i, points_[i])) {
                    return true;
                }
            }
            return false;
        });
    }

private:
    static constexpr std::uint32_t kEnd = std::numeric_limits<std::uint32_t>::max();

    GridCells cells_;
    std::vector<Vec2> points_;
    std::vector<std::uint32_t> heads_;  // first point of each cell
    std::vector<std::uint32_t> next_;   // the next point of the same cell
};

template <class Found>
bool GridCells::any_near(Vec2 centre, float radius_mm, Found const& is_found) const {
    return any_run_near(centre, radius_mm, [&](std::size_t first, std::size_t last) {
        for (std::size_t cell = first; cell <= last; ++cell) {
            if (is_found(cell)) {
                return true;
            }
        }
        return false;
    });
}

template <class Found>
bool GridCells::any_run_near(Vec2 centre, float radius_mm, Found const& is_found) const {
    Vec2 const low = centre - origin_ - Vec2{radius_mm, radius_mm};
    Vec2 const high = centre - origin_ + Vec2{radius_mm, radius_mm};
    Span const columns = cells(low.x * columns_per_mm_, high.x * columns_per_mm_, columns_, periodic_);
    Span const rows = cells(low.y * rows_per_mm_, high.y * rows_per_mm_, rows_, periodic_);
    int const first = periodic_ ? remainder(columns.first, columns_) : columns.first;
    int const last = first + columns.last - columns.first;
    for (int r = rows.first; r <= rows.last; ++r) {
        int const row = periodic_ ? remainder(r, rows_) : r;
        if (is_found(index(first, row), index(std::min(last, columns_ - 1), row))) {
            return true;
        }
        // The rest of a run that continues at the other end of a periodic row.
        if (last >= columns_ && is_found(index(0, row), index(last - columns_, row))) {
            return true;
        }
    }
    return false;
}

}  // namespace pogosim
