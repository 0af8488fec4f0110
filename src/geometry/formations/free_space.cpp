#include "geometry/formations/free_space.hpp"

#include <algorithm>
#include <limits>

namespace pogosim {

namespace {

constexpr std::size_t kMostBands = 128;
constexpr int kMostPushes = 20;
constexpr float kPushMargin = 1.0005F;  // so that rounding does not leave a point short of its clearance

}  // namespace

FreeSpace::FreeSpace(Arena const& arena) : bounds_(arena.bounds) {
    for (std::size_t p = 0; p < arena.polygons.size(); ++p) {
        add_walls(arena.polygons[p], p > 0);
    }
    bands_.resize(std::min(walls_.size(), kMostBands));
    for (std::uint32_t w = 0; w < walls_.size(); ++w) {
        auto const [top, bottom] = std::minmax(walls_[w].from.y, walls_[w].to.y);
        for (std::size_t band = band_of(top); band <= band_of(bottom); ++band) {
            bands_[band].push_back(w);
        }
    }
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

std::size_t FreeSpace::band_of(float y) const {
    float const fraction = (y - bounds_.min.y) / bounds_.size().y;
    float const band = fraction * static_cast<float>(bands_.size());
    return static_cast<std::size_t>(std::clamp(band, 0.0F, static_cast<float>(bands_.size() - 1)));
}

bool FreeSpace::contains(Vec2 point) const {
    if (point.y < bounds_.min.y || point.y > bounds_.max.y) {
        return false;
    }
    bool inside = false;
    for (std::uint32_t const w : bands_[band_of(point.y)]) {
        inside ^= ray_crosses(walls_[w].from, walls_[w].to, point);
    }
    return inside;
}

FreeSpace::Wall const* FreeSpace::nearest_wall_within(Vec2 point, float reach) const {
    Wall const* nearest = nullptr;
    float nearest_squared = reach * reach;
    for (std::size_t band = band_of(point.y - reach); band <= band_of(point.y + reach); ++band) {
        for (std::uint32_t const w : bands_[band]) {
            Wall const& wall = walls_[w];
            float const squared = squared_length(point - nearest_on_segment(wall.from, wall.to, point));
            if (squared < nearest_squared) {
                nearest_squared = squared;
                nearest = &wall;
            }
        }
    }
    return nearest;
}

bool FreeSpace::holds(Vec2 point_mm, float clearance_mm) const {
    return contains(point_mm) && nearest_wall_within(point_mm, clearance_mm) == nullptr;
}

Vec2 FreeSpace::pushed_inside(Vec2 point_mm, float clearance_mm) const {
    for (int push = 0; push < kMostPushes; ++push) {
        bool const inside = contains(point_mm);
        float const reach = inside ? clearance_mm : 2.0F * length(bounds_.size()) + length(point_mm - bounds_.centre());
        Wall const* const wall = nearest_wall_within(point_mm, reach);
        if (wall == nullptr) {
            break;
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
