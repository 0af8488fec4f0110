#include "geometry/formations/free_space.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace pogosim {

namespace {

constexpr int kMostPushes = 20;
constexpr double kAreaPoints = 2.0e4;      // in the arena, to estimate what part of it is free
constexpr double kMostAreaPoints = 1.0e6;  // in its bounding box

constexpr std::size_t kCellsPerSide = 32;  // of the grid over the bounds: most of them are far from walls
constexpr float kCellMargin = 0.01F;       // of a cell's size: rounding is far below

std::size_t count_edges(Arena const& arena) {
    std::size_t count = 0;
    for (Polygon const& polygon : arena.polygons) {
        count += polygon.size();
    }
    return count;
}

/// How many cells of the grid there are for each mm.
Vec2 per_mm(Vec2 size_mm) {
    constexpr auto kCells = static_cast<float>(kCellsPerSide);
    return {kCells / size_mm.x, kCells / size_mm.y};
}

double area_of(Box box) {
    return static_cast<double>(box.size().x) * static_cast<double>(box.size().y);
}

}  // namespace

FreeSpace::FreeSpace(Arena const& arena, std::span<Obstacle const> obstacles)
    : bounds_(arena.bounds),
      cells_per_mm_(per_mm(arena.bounds.size())),
      arena_share_(arena.area_mm2 / area_of(arena.bounds)),
      bands_(arena.bounds, count_edges(arena)),
      obstacles_(obstacles, arena.bounds) {
    for (std::size_t p = 0; p < arena.polygons.size(); ++p) {
        add_walls(arena.polygons[p], p > 0);
    }
    for (std::uint32_t w = 0; w < walls_.size(); ++w) {
        auto const [top, bottom] = std::minmax(walls_[w].from.y, walls_[w].to.y);
        bands_.add(w, top, bottom);
    }
    find_sides();
}

void FreeSpace::add_walls(Polygon const& polygon, bool is_hole) {
    // Seen along an edge of a clockwise outer polygon (positive area, y down), the arena is where +y is from +x.
    float const turn = (signed_area(polygon) > 0.0) != is_hole ? 1.0F : -1.0F;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        Vec2 const from = polygon[i];
        Vec2 const to = polygon[(i + 1) % polygon.size()];
        float const length_mm = length(to - from);
        if (length_mm > 0.0F) {
            Vec2 const along = (1.0F / length_mm) * (to - from);
            walls_.push_back({from, to, turn * Vec2{-along.y, along.x}});
            length_up_to_.push_back((length_up_to_.empty() ? 0.0 : length_up_to_.back()) + length_mm);
        }
    }
}

std::size_t FreeSpace::cell_at(Vec2 point) const {
    constexpr auto kMost = static_cast<float>(kCellsPerSide - 1);
    float const column = (point.x - bounds_.min.x) * cells_per_mm_.x;
    float const row = (point.y - bounds_.min.y) * cells_per_mm_.y;
    return static_cast<std::size_t>(std::clamp(row, 0.0F, kMost)) * kCellsPerSide +
           static_cast<std::size_t>(std::clamp(column, 0.0F, kMost));
}

Vec2 FreeSpace::centre_of(std::size_t cell) const {
    constexpr float kPart = 1.0F / static_cast<float>(kCellsPerSide);
    Vec2 const size = bounds_.size();
    return bounds_.min + Vec2{(static_cast<float>(cell % kCellsPerSide) + 0.5F) * kPart * size.x,
                              (static_cast<float>(cell / kCellsPerSide) + 0.5F) * kPart * size.y};
}

/// Marks the cells that a wall comes near as unknown: those around each piece of it that is shorter than a cell.
void FreeSpace::mark_cells_by(Wall const& wall) {
    Vec2 const cell = (1.0F / static_cast<float>(kCellsPerSide)) * bounds_.size();
    Vec2 const way = wall.to - wall.from;
    Vec2 const margin = kCellMargin * cell;
    int const pieces = 1 + static_cast<int>(std::max(std::fabs(way.x) / cell.x, std::fabs(way.y) / cell.y));
    Vec2 const step = (1.0F / static_cast<float>(pieces)) * way;
    for (int piece = 0; piece < pieces; ++piece) {
        Vec2 const a = wall.from + static_cast<float>(piece) * step;
        Vec2 const b = a + step;
        std::size_t const first = cell_at(Vec2{std::min(a.x, b.x), std::min(a.y, b.y)} - margin);
        std::size_t const last = cell_at(Vec2{std::max(a.x, b.x), std::max(a.y, b.y)} + margin);
        for (std::size_t row = first / kCellsPerSide; row <= last / kCellsPerSide; ++row) {
            for (std::size_t column = first % kCellsPerSide; column <= last % kCellsPerSide; ++column) {
                sides_[row * kCellsPerSide + column] = Side::kUnknown;
            }
        }
    }
}

void FreeSpace::find_sides() {
    Vec2 const size = bounds_.size();
    bool const has_area = size.x > 0.0F && size.y > 0.0F;
    sides_.assign(kCellsPerSide * kCellsPerSide, has_area ? Side::kOutside : Side::kUnknown);
    if (!has_area) {
        return;
    }
    std::ranges::for_each(walls_, [&](Wall const& wall) { mark_cells_by(wall); });
    for (std::size_t cell = 0; cell < sides_.size(); ++cell) {
        if (sides_[cell] == Side::kUnknown) {
            continue;
        }
        // Cells that follow each other with no wall between are on the same side.
        bool const is_next = cell % kCellsPerSide > 0 && sides_[cell - 1] != Side::kUnknown;
        sides_[cell] = is_next ? sides_[cell - 1] : is_enclosed(centre_of(cell)) ? Side::kInside : Side::kOutside;
    }
}

bool FreeSpace::contains(Vec2 point) const {
    if (point.y < bounds_.min.y || point.y > bounds_.max.y) {
        return false;
    }
    Side const side = sides_[cell_at(point)];
    // Beside the bounds, the nearest cell may be known to be outside, never inside: a wall is at the bounds.
    return side == Side::kUnknown ? is_enclosed(point) : side == Side::kInside;
}

bool FreeSpace::is_enclosed(Vec2 point) const {
    bool inside = false;
    for (std::uint32_t const w : bands_.at(point.y)) {
        inside ^= ray_crosses(walls_[w].from, walls_[w].to, point);
    }
    return inside;
}

FreeSpace::Wall const* FreeSpace::nearest_wall_within(Vec2 point, float reach) const {
    Wall const* nearest = nullptr;
    if (reach <= 0.0F) {
        return nearest;
    }
    float nearest_squared = reach * reach;
    bands_.for_each_between(point.y - reach, point.y + reach, [&](std::uint32_t w) {
        Wall const& wall = walls_[w];
        float const squared = squared_length(point - nearest_on_segment(wall.from, wall.to, point));
        if (squared < nearest_squared) {
            nearest_squared = squared;
            nearest = &wall;
        }
    });
    return nearest;
}

bool FreeSpace::holds(Vec2 point_mm, float clearance_mm) const {
    return contains(point_mm) && nearest_wall_within(point_mm, clearance_mm) == nullptr &&
           obstacles_.is_clear(point_mm, clearance_mm);
}

double FreeSpace::free_share() const {
    if (obstacles_.empty()) {
        return 1.0;
    }
    // On a grid of square cells.
    double const points = std::min(kAreaPoints / arena_share_, kMostAreaPoints);
    Vec2 const size = bounds_.size();
    auto const pitch_mm = static_cast<float>(std::sqrt(area_of(bounds_) / points));
    std::size_t inside = 0;
    std::size_t free = 0;
    for (float y = 0.5F * pitch_mm; y < size.y; y += pitch_mm) {
        for (float x = 0.5F * pitch_mm; x < size.x; x += pitch_mm) {
            Vec2 const point = bounds_.min + Vec2{x, y};
            if (contains(point)) {
                ++inside;
                free += obstacles_.is_clear(point, 0.0F) ? 1 : 0;
            }
        }
    }
    return inside == 0 ? 1.0 : static_cast<double>(free) / static_cast<double>(inside);
}

Vec2 FreeSpace::pushed_inside(Vec2 point_mm, float clearance_mm) const {
    for (int push = 0; push < kMostPushes; ++push) {
        bool const inside = contains(point_mm);
        float const reach = inside ? clearance_mm : 2.0F * length(bounds_.size()) + length(point_mm - bounds_.centre());
        Wall const* const wall = nearest_wall_within(point_mm, reach);
        if (wall == nullptr) {
            std::optional<Vec2> const place = obstacles_.pushed_off(point_mm, clearance_mm);
            if (!place) {
                break;
            }
            point_mm = *place;
            continue;
        }
        Vec2 const foot = nearest_on_segment(wall->from, wall->to, point_mm);
        Vec2 const away = inside ? point_mm - foot : foot - point_mm;
        float const distance_mm = length(away);
        Vec2 const unit = distance_mm > 0.0F ? (1.0F / distance_mm) * away : wall->inward;
        point_mm = foot + clearance_mm * kPushMargin * unit;
    }
    return point_mm;
}

Vec2 FreeSpace::random_point(RandomStream& random) const {
    float const x = random.uniform(bounds_.min.x, bounds_.max.x);
    float const y = random.uniform(bounds_.min.y, bounds_.max.y);
    return {x, y};
}

Vec2 FreeSpace::random_point_along_walls(float clearance_mm, RandomStream& random) const {
    double const along = length_up_to_.back() * static_cast<double>(random.uniform());
    auto const found = std::ranges::upper_bound(length_up_to_, along);
    auto const index = std::min(static_cast<std::size_t>(found - length_up_to_.begin()), walls_.size() - 1);
    Wall const& wall = walls_[index];
    return wall.from + random.uniform() * (wall.to - wall.from) + clearance_mm * wall.inward;
}

}  // namespace pogosim
