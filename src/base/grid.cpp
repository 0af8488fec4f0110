#include "base/grid.hpp"

#include <numeric>

namespace pogosim {

namespace {

int cell_count(float length_mm, float cell_mm, float most) {
    return static_cast<int>(std::clamp(std::floor(length_mm / cell_mm), 1.0F, most));
}

}  // namespace

GridCells::Span GridCells::cells(float low, float high, int count, bool periodic) {
    auto const whole = static_cast<float>(count);
    if (!periodic) {
        return {clamp_cell(low, count), clamp_cell(high, count)};
    }
    if (high - low >= whole - 1.0F) {
        return {0, count - 1};
    }
    return {static_cast<int>(std::floor(low)), static_cast<int>(std::floor(high))};
}

GridCells::GridCells(Box bounds, float smallest_cell_mm, std::size_t point_count, bool periodic)
    : origin_(bounds.min), periodic_(periodic) {
    // Limits the number of cells to a few per point, however small the requested cells.
    float const most = std::max(1.0F, 2.0F * std::sqrt(static_cast<float>(point_count)));
    Vec2 const size = bounds.size();
    columns_ = cell_count(size.x, smallest_cell_mm, most);
    rows_ = cell_count(size.y, smallest_cell_mm, most);
    columns_per_mm_ = static_cast<float>(columns_) / size.x;
    rows_per_mm_ = static_cast<float>(rows_) / size.y;
}

void UniformGrid::build(std::span<Vec2 const> points, Box bounds, float cell_mm, bool periodic) {
    cells_ = GridCells(bounds, cell_mm, points.size(), periodic);

    // Counting sort by cell.
    std::size_t const cells = cells_.size();
    start_.assign(cells + 1, 0);
    cell_.resize(points.size());
    items_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        cell_[i] = static_cast<std::uint32_t>(cells_.cell_of(points[i]));
        ++start_[cell_[i] + 1];
    }
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    for (std::size_t i = points.size(); i-- > 0;) {
        // Filling from the back moves each cell's end to its start.
        items_[--start_[cell_[i] + 1]] = {points[i], static_cast<std::uint32_t>(i)};
    }
    // Now start_[c + 1] is the start of cell c: shift back.
    for (std::size_t c = 0; c < cells; ++c) {
        start_[c] = start_[c + 1];
    }
    start_[cells] = static_cast<std::uint32_t>(points.size());
}

}  // namespace pogosim
