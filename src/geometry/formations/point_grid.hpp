// Points sorted into square cells, to find those near a place.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/vec2.hpp"

namespace pogosim {

/// Points beyond the bounds are kept in the border cells, so that every search also finds them.
class PointGrid {
public:
    /// Cells are at least `smallest_cell_mm` wide, and wide enough for about one of `point_count` points each.
    PointGrid(Box bounds_mm, float smallest_cell_mm, std::size_t point_count)
        : origin_(bounds_mm.min), next_(point_count, kNone) {
        Vec2 const size = bounds_mm.size();
        float const one_each = std::sqrt(size.x * size.y / static_cast<float>(point_count + 1));
        cell_mm_ = std::max({smallest_cell_mm, one_each, 1.0e-3F * std::max(size.x, size.y)});
        columns_ = static_cast<int>(size.x / cell_mm_) + 1;
        rows_ = static_cast<int>(size.y / cell_mm_) + 1;
        points_.resize(point_count);
        clear();
    }

    void clear() { heads_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), kNone); }

    /// Adds the point under a number below `point_count` that is not in the grid yet.
    void insert(std::uint32_t index, Vec2 point) {
        std::uint32_t& head = heads_[cell_index(column(point.x), row(point.y))];
        points_[index] = point;
        next_[index] = head;
        head = index;
    }

    /// True when match(index, point) holds for some point; asks for all those within `reach_mm`, and some more.
    template <typename Match>
    bool any_near(Vec2 centre, float reach_mm, Match match) const {
        for (int r = row(centre.y - reach_mm); r <= row(centre.y + reach_mm); ++r) {
            for (int c = column(centre.x - reach_mm); c <= column(centre.x + reach_mm); ++c) {
                for (std::uint32_t i = heads_[cell_index(c, r)]; i != kNone; i = next_[i]) {
                    if (match(i, points_[i])) {
                        return true;
                    }
                }
            }
        }
        return false;
    }

    /// Calls visit(index, point) in growing square rings of cells around a point within the bounds, until done(gap_mm):
    /// no point nearer than `gap_mm` is left.
    template <typename Visit, typename Done>
    void search_outwards(Vec2 centre, Visit visit, Done done) const {
        int const c = column(centre.x);
        int const r = row(centre.y);
        float const x = centre.x - origin_.x - cell_mm_ * static_cast<float>(c);
        float const y = centre.y - origin_.y - cell_mm_ * static_cast<float>(r);
        float const to_border = std::max(std::min({x, cell_mm_ - x, y, cell_mm_ - y}), 0.0F);
        int const last = std::max({c, columns_ - 1 - c, r, rows_ - 1 - r});
        for (int ring = 0; ring <= last; ++ring) {
            if (ring > 0 && done(static_cast<float>(ring - 1) * cell_mm_ + to_border)) {
                return;
            }
            for (int i = std::max(r - ring, 0); i <= std::min(r + ring, rows_ - 1); ++i) {
                // Whole rows at the top and bottom of the ring, its two sides in between.
                int const stride = i == r - ring || i == r + ring || ring == 0 ? 1 : 2 * ring;
                for (int j = c - ring; j <= c + ring; j += stride) {
                    if (j >= 0 && j < columns_) {
                        visit_cell(cell_index(j, i), visit);
                    }
                }
            }
        }
    }

private:
    static constexpr std::uint32_t kNone = 0xffffffffU;

    static int clamped(float cell, int count) {
        return static_cast<int>(std::clamp(cell, 0.0F, static_cast<float>(count - 1)));
    }
    int column(float x) const { return clamped((x - origin_.x) / cell_mm_, columns_); }
    int row(float y) const { return clamped((y - origin_.y) / cell_mm_, rows_); }
    std::size_t cell_index(int c, int r) const {
        return static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(c);
    }
    template <typename Visit>
    void visit_cell(std::size_t cell, Visit visit) const {
        for (std::uint32_t i = heads_[cell]; i != kNone; i = next_[i]) {
            visit(i, points_[i]);
        }
    }

    Vec2 origin_;
    float cell_mm_ = 1.0F;
    int columns_ = 1;
    int rows_ = 1;
    std::vector<Vec2> points_;
    std::vector<std::uint32_t> heads_;  // first point of each cell
    std::vector<std::uint32_t> next_;   // the next point of the same cell
};

}  // namespace pogosim
