#include "physics/neighbour_list.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pogosim {

namespace {

// Width of the skin relative to the largest radius in the cells: a list with a wider skin is rebuilt less often, but
// has more pairs.
constexpr float kSkinShare = 0.6F;
// Cells are as wide as two of the largest disks in them. Disks larger than this quantile of all radii are not in cells.
constexpr double kInCells = 0.98;
// Largest number of cells per body.
constexpr double kCellsPerBody = 2.0;
// Smallest size of a range that one worker takes.
constexpr std::uint32_t kLeastBodies = 8192;
constexpr std::uint32_t kLeastCells = 256;

float radius_in_cells(Bodies const& bodies) {
    std::vector<float> radii = bodies.radius_mm;
    if (radii.empty()) {
        return 1.0F;
    }
    auto const place = static_cast<std::size_t>(kInCells * static_cast<double>(radii.size() - 1));
    std::ranges::nth_element(radii, radii.begin() + static_cast<std::ptrdiff_t>(place));
    // Cells for disks of up to twice the size cost less than testing the large disks one by one.
    return 2.0F * radii[place] >= std::ranges::max(radii) ? std::ranges::max(radii) : radii[place];
}

int cell_count(float length_mm, float cell_mm, double most) {
    return static_cast<int>(std::clamp(std::floor(static_cast<double>(length_mm) / cell_mm), 1.0, most));
}

}  // namespace

NeighbourList::NeighbourList(World const& world) : largest_mm_(radius_in_cells(world.bodies)) {
    for (BodySpec const& spec : world.bodies.spec) {
        is_fixed_.push_back(spec.fixed ? 1 : 0);
    }
}

/// Chooses as many cells as the skin allows, and the bodies that go into them.
void NeighbourList::lay_cells(World const& world) {
    Bodies const& bodies = world.bodies;
    double const most = std::max(1.0, std::sqrt(kCellsPerBody * static_cast<double>(bodies.size())));
    float const cell_mm = 2.0F * largest_mm_ + skin_mm_;
    Vec2 const size = world.arena.bounds.size();
    columns_ = cell_count(size.x, cell_mm, most);
    rows_ = cell_count(size.y, cell_mm, most);
    columns_per_mm_ = static_cast<float>(columns_) / size.x;
    rows_per_mm_ = static_cast<float>(rows_) / size.y;
    // In a periodic world with fewer than three cells along an axis, a cell's neighbour would be on both of its sides.
    bool const has_cells = !world.periodic || std::min(columns_, rows_) >= 3;
    large_.clear();
    is_large_.assign(bodies.size(), 0);
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        if (!has_cells || bodies.radius_mm[i] > largest_mm_) {
            is_large_[i] = 1;
            large_.push_back(i);
        }
    }
    cell_.resize(bodies.size());
    start_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
    items_.resize(bodies.size() - large_.size());
}

bool NeighbourList::covers(World const& world, float reach_mm, WorkerPool& workers) const {
    if (!is_built_ || reach_mm > skin_mm_) {
        return false;
    }
    std::vector<Vec2> const& position_mm = world.bodies.position_mm;
    auto const count = static_cast<std::uint32_t>(position_mm.size());
    float const farthest2 = workers.max_of_ranges(count, kLeastBodies, [&](WorkRange range) {
        float farthest2 = 0.0F;
        for (std::uint32_t i = range.first; i < range.last; ++i) {
            farthest2 = std::max(farthest2, squared_length(minimum_image(world, built_mm_[i], position_mm[i])));
        }
        return farthest2;
    });
    return 2.0F * std::sqrt(farthest2) + reach_mm <= skin_mm_;
}

std::uint32_t NeighbourList::cell_at(World const& world, Vec2 point_mm) const {
    auto const at = [](float place, int count) {
        return static_cast<std::uint32_t>(std::clamp(place, 0.0F, static_cast<float>(count - 1)));
    };
    Vec2 const offset = point_mm - world.arena.bounds.min;
    return at(offset.y * rows_per_mm_, rows_) * static_cast<std::uint32_t>(columns_) +
           at(offset.x * columns_per_mm_, columns_);
}

void NeighbourList::sort_into_cells(World const& world) {
    Bodies const& bodies = world.bodies;
    // Counting sort by cell.
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        cell_[i] = cell_at(world, wrapped(world, bodies.position_mm[i]));
        start_[cell_[i] + 1] += is_large_[i] == 0 ? 1U : 0U;
    }
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    for (std::uint32_t i = static_cast<std::uint32_t>(bodies.size()); i-- > 0;) {
        if (is_large_[i] == 0) {
            items_[--start_[cell_[i] + 1]] = {wrapped(world, bodies.position_mm[i]), bodies.radius_mm[i], i};
        }
    }
    // Filling from the back has moved each cell's end to its start.
    std::copy(start_.begin() + 1, start_.end(), start_.begin());
    start_.back() = static_cast<std::uint32_t>(items_.size());
}

bool NeighbourList::are_near(Item const& a, Item const& b, Vec2 shift_mm) const {
    float const reach_mm = a.radius_mm + b.radius_mm + skin_mm_;
    bool const is_within = squared_length(b.position_mm + shift_mm - a.position_mm) < reach_mm * reach_mm;
    return is_within & ((is_fixed_[a.body] & is_fixed_[b.body]) == 0);
}

void NeighbourList::add_if_near(Item const& a, Item const& b, Vec2 shift_mm) {
    if (are_near(a, b, shift_mm)) {
        pairs_.push_back({a.body, b.body});
    }
}

/// Finds the pairs of a cell with itself, its right neighbour and the three below, which lie in two contiguous rows.
/// Branch-free, since which disks are near is hard to predict.
void NeighbourList::find_around(std::uint32_t cell, std::vector<NeighbourPair>& pairs) const {
    auto const columns = static_cast<std::uint32_t>(columns_);
    std::uint32_t const column = cell % columns;
    bool const has_right = column + 1 < columns;
    std::uint32_t const end = start_[cell + (has_right ? 2 : 1)];
    std::uint32_t below = 0;
    std::uint32_t below_end = 0;
    if (cell / columns + 1 < static_cast<std::uint32_t>(rows_)) {
        below = start_[cell + columns - (column > 0 ? 1 : 0)];
        below_end = start_[cell + columns + (has_right ? 2 : 1)];
    }
    for (std::uint32_t i = start_[cell]; i < start_[cell + 1]; ++i) {
        Item const& item = items_[i];
        std::size_t count = pairs.size();
        pairs.resize(count + (end - i - 1) + (below_end - below));
        auto const look_at = [&](Item const& other) {
            pairs[count] = {item.body, other.body};
            count += are_near(item, other, {}) ? 1 : 0;
        };
        for (std::uint32_t k = i + 1; k < end; ++k) {
            look_at(items_[k]);
        }
        for (std::uint32_t k = below; k < below_end; ++k) {
            look_at(items_[k]);
        }
        pairs.resize(count);
    }
}

void NeighbourList::find_between(std::uint32_t cell, std::uint32_t other, Vec2 shift_mm) {
    for (std::uint32_t i = start_[cell]; i < start_[cell + 1]; ++i) {
        for (std::uint32_t k = start_[other]; k < start_[other + 1]; ++k) {
            add_if_near(items_[i], items_[k], shift_mm);
        }
    }
}

/// Finds pairs across the seams of a periodic world, which has at least three columns and rows.
void NeighbourList::find_across_seams(Vec2 size_mm) {
    auto const cell_at = [&](int column, int row) { return static_cast<std::uint32_t>(row * columns_ + column); };
    for (int row = 0; row < rows_; ++row) {
        bool const is_last = row + 1 == rows_;
        int const below = is_last ? 0 : row + 1;
        float const down_mm = is_last ? size_mm.y : 0.0F;
        find_between(cell_at(columns_ - 1, row), cell_at(0, row), {size_mm.x, 0.0F});
        find_between(cell_at(columns_ - 1, row), cell_at(0, below), {size_mm.x, down_mm});
        find_between(cell_at(0, row), cell_at(columns_ - 1, below), {-size_mm.x, down_mm});
    }
    for (int column = 0; column < columns_; ++column) {
        for (int other = std::max(column - 1, 0); other <= std::min(column + 1, columns_ - 1); ++other) {
            find_between(cell_at(column, rows_ - 1), cell_at(other, 0), {0.0F, size_mm.y});
        }
    }
}

/// Calls visit(first, last) for each row of items in the cells around a disk, without crossing a seam.
template <class Visit>
void NeighbourList::for_each_row_near(World const& world, Item const& disk, Visit const& visit) const {
    float const reach_mm = disk.radius_mm + largest_mm_ + skin_mm_;
    Vec2 const reach{reach_mm, reach_mm};
    std::uint32_t const first = cell_at(world, disk.position_mm - reach);
    std::uint32_t const last = cell_at(world, disk.position_mm + reach);
    auto const columns = static_cast<std::uint32_t>(columns_);
    for (std::uint32_t row = first / columns; row <= last / columns; ++row) {
        visit(start_[row * columns + first % columns], start_[row * columns + last % columns + 1]);
    }
}

/// Finds the pairs of disks that are too large for the cells.
void NeighbourList::find_of_large(World const& world) {
    Bodies const& bodies = world.bodies;
    auto const item_of = [&](std::uint32_t i) {
        return Item{wrapped(world, bodies.position_mm[i]), bodies.radius_mm[i], i};
    };
    auto const add = [&](Item const& a, Item const& b) {
        Vec2 const way = b.position_mm - a.position_mm;
        add_if_near(a, b, minimum_image(world, a.position_mm, b.position_mm) - way);
    };
    for (std::size_t k = 0; k < large_.size(); ++k) {
        Item const disk = item_of(large_[k]);
        for (std::size_t other = k + 1; other < large_.size(); ++other) {
            add(disk, item_of(large_[other]));
        }
        if (world.periodic) {
            std::ranges::for_each(items_, [&](Item const& item) { add(disk, item); });
        } else {
            for_each_row_near(world, disk, [&](std::uint32_t first, std::uint32_t last) {
                for (std::uint32_t i = first; i < last; ++i) {
                    add(disk, items_[i]);
                }
            });
        }
    }
}

/// In the order of the cells, whichever worker searches which.
void NeighbourList::find_in_cells(WorkerPool& workers) {
    auto const cells = static_cast<std::uint32_t>(start_.size() - 1);
    more_.resize(workers.range_count(cells, kLeastCells) - 1);
    workers.run_ranges(cells, kLeastCells, [&](WorkRange range) {
        std::vector<NeighbourPair>& pairs = range.part == 0 ? pairs_ : more_[range.part - 1];
        pairs.clear();
        for (std::uint32_t cell = range.first; cell < range.last; ++cell) {
            find_around(cell, pairs);
        }
    });
    for (std::vector<NeighbourPair> const& pairs : more_) {
        pairs_.insert(pairs_.end(), pairs.begin(), pairs.end());
    }
}

void NeighbourList::build(World const& world, float reach_mm, WorkerPool& workers) {
    skin_mm_ = reach_mm + kSkinShare * largest_mm_;
    lay_cells(world);
    sort_into_cells(world);
    find_in_cells(workers);
    if (world.periodic) {
        find_across_seams(world.arena.bounds.size());
    }
    find_of_large(world);
    built_mm_ = world.bodies.position_mm;
    is_built_ = true;
}

}  // namespace pogosim
