#include "geometry/wall_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pogosim {

namespace {

// Cells along the longer side of the arena: about as many edges as rows and columns, within reason.
constexpr double kFewestCells = 8.0;
constexpr double kMostCells = 512.0;

/// Coordinates reach 1e9 mm, where squares of differences need more than a float.
struct Vec2d {
    double x = 0.0;
    double y = 0.0;

    friend Vec2d operator-(Vec2d a, Vec2d b) { return {a.x - b.x, a.y - b.y}; }
    friend Vec2d operator+(Vec2d a, Vec2d b) { return {a.x + b.x, a.y + b.y}; }
    friend Vec2d operator*(double s, Vec2d a) { return {s * a.x, s * a.y}; }
};

Vec2d wide(Vec2 a) {
    return {a.x, a.y};
}
double dot(Vec2d a, Vec2d b) {
    return a.x * b.x + a.y * b.y;
}
double length(Vec2d a) {
    return std::sqrt(dot(a, a));
}

/// An edge as a disk meets it. The distance from a segment is convex along a straight line.
class Wall {
public:
    Wall(Vec2 from, Vec2 to) : a_(wide(from)), b_(wide(to)), length_(length(b_ - a_)) {
        if (length_ > 0.0) {
            along_ = 1.0 / length_ * (b_ - a_);
        }
    }

    Vec2d nearest(Vec2d point) const { return a_ + std::clamp(dot(point - a_, along_), 0.0, length_) * along_; }

    /// From the wall to the point; towards free space when the point lies on the wall.
    Vec2d normal_at(Vec2d point) const {
        Vec2d const offset = point - nearest(point);
        double const distance = length(offset);
        return distance > 0.0 ? 1.0 / distance * offset : Vec2d{-along_.y, along_.x};
    }

    /// Fraction of the motion after which the centre is `radius` from the wall, as in WallIndex::first_touch(); more
    /// than 1: it does not come so near.
    double touch(Vec2d from, Vec2d motion, double radius) const {
        if (length(from - nearest(from)) <= radius) {
            return dot(motion, normal_at(from)) < 0.0 ? 0.0 : kNever;
        }
        return std::min({touch_of_side(from, motion, radius), touch_of_end(a_, from, motion, radius),
                         touch_of_end(b_, from, motion, radius)});
    }

private:
    static constexpr double kNever = std::numeric_limits<double>::infinity();

    double touch_of_side(Vec2d from, Vec2d motion, double radius) const {
        Vec2d const across{-along_.y, along_.x};
        double const height = dot(from - a_, across);
        double const approach = height > 0.0 ? -dot(motion, across) : dot(motion, across);
        double const start = dot(from - a_, along_);
        bool const is_beside = start >= 0.0 && start <= length_;
        // Beside the edge the centre is outside of the radius, give or take a rounding.
        double const gap = is_beside ? std::max(std::abs(height) - radius, 0.0) : std::abs(height) - radius;
        if (gap < 0.0 || approach <= gap) {
            return kNever;
        }
        double const fraction = gap / approach;
        double const place = dot(from + fraction * motion - a_, along_);
        return place >= 0.0 && place <= length_ ? fraction : kNever;
    }

    static double touch_of_end(Vec2d end, Vec2d from, Vec2d motion, double radius) {
        // |from + t motion - end|^2 = radius^2, the smaller t.
        Vec2d const offset = from - end;
        double const a = dot(motion, motion);
        double const b = dot(offset, motion);
        double const c = std::max(dot(offset, offset) - radius * radius, 0.0);
        double const discriminant = b * b - a * c;
        if (b >= 0.0 || discriminant < 0.0) {
            return kNever;
        }
        double const fraction = c / (-b + std::sqrt(discriminant));
        return fraction <= 1.0 ? fraction : kNever;
    }

    Vec2d a_;
    Vec2d b_;
    double length_;
    Vec2d along_{0.0, 0.0};
};

Box box_around(Vec2 a, Vec2 b, float margin) {
    return {{std::min(a.x, b.x) - margin, std::min(a.y, b.y) - margin},
            {std::max(a.x, b.x) + margin, std::max(a.y, b.y) + margin}};
}

}  // namespace

int WallIndex::column_of(float x_mm) const {
    return static_cast<int>(std::clamp((x_mm - origin_mm_.x) / cell_mm_, 0.0F, static_cast<float>(columns_ - 1)));
}

int WallIndex::row_of(float y_mm) const {
    return static_cast<int>(std::clamp((y_mm - origin_mm_.y) / cell_mm_, 0.0F, static_cast<float>(rows_ - 1)));
}

WallIndex::Cells WallIndex::cells_of(Box const& box) const {
    return {column_of(box.min.x), column_of(box.max.x), row_of(box.min.y), row_of(box.max.y)};
}

template <class Visit>
void WallIndex::for_each_cell(WallEdge const& edge, Visit const& visit) const {
    // In each row, the columns that the edge crosses, with a margin for rounding.
    float const margin = 0.01F * cell_mm_;
    Cells const cells = cells_of(box_around(edge.from, edge.to, margin));
    Vec2 const way = edge.to - edge.from;
    for (int row = cells.first_row; row <= cells.last_row; ++row) {
        float low = 0.0F;
        float high = 1.0F;
        if (way.y != 0.0F && cells.first_row != cells.last_row) {
            float const top = origin_mm_.y + static_cast<float>(row) * cell_mm_ - margin - edge.from.y;
            float const bottom = top + cell_mm_ + 2.0F * margin;
            low = std::clamp(std::min(top / way.y, bottom / way.y), 0.0F, 1.0F);
            high = std::clamp(std::max(top / way.y, bottom / way.y), 0.0F, 1.0F);
        }
        Box const part = box_around(edge.from + low * way, edge.from + high * way, margin);
        for (int column = column_of(part.min.x); column <= column_of(part.max.x); ++column) {
            visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(column));
        }
    }
}

WallIndex::WallIndex(Arena const& arena) : origin_mm_(arena.bounds.min) {
    for (Polygon const& polygon : arena.polygons) {
        bool const is_outer = &polygon == &arena.polygons.front();
        bool const forward = (signed_area(polygon) > 0.0) == is_outer;
        auto const first = static_cast<std::uint32_t>(all_.size());
        auto const count = static_cast<std::uint32_t>(polygon.size());
        for (std::uint32_t i = 0; i < count; ++i) {
            Vec2 const from = polygon[i];
            Vec2 const to = polygon[(i + 1) % count];
            std::uint32_t const before = first + (i + (forward ? count - 1 : 1)) % count;
            all_.push_back(
                {.from = forward ? from : to, .to = forward ? to : from, .number = first + i, .previous = before});
        }
    }
    Vec2 const size = arena.bounds.size();
    double const along = std::clamp(2.0 * std::sqrt(static_cast<double>(all_.size())), kFewestCells, kMostCells);
    cell_mm_ = std::max(size.x, size.y) / static_cast<float>(along);
    columns_ = static_cast<int>(size.x / cell_mm_) + 1;
    rows_ = static_cast<int>(size.y / cell_mm_) + 1;

    // Counting sort by cell.
    start_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
    for (WallEdge const& edge : all_) {
        for_each_cell(edge, [&](std::size_t cell) { ++start_[cell + 1]; });
    }
    for (std::size_t cell = 1; cell < start_.size(); ++cell) {
        start_[cell] += start_[cell - 1];
    }
    edges_.resize(start_.back());
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    for (WallEdge const& edge : all_) {
        for_each_cell(edge, [&](std::size_t cell) { edges_[next[cell]++] = edge; });
    }
}

float WallIndex::distance(Vec2 point_mm, float most_mm) const {
    double nearest = most_mm;
    Vec2d const point = wide(point_mm);
    for_each_edge(box_around(point_mm, point_mm, most_mm), [&](WallEdge const& edge) {
        nearest = std::min(nearest, length(point - Wall(edge.from, edge.to).nearest(point)));
    });
    return static_cast<float>(nearest);
}

std::optional<WallTouch> WallIndex::first_touch(Vec2 from_mm, Vec2 motion_mm, float radius_mm) const {
    Vec2d const from = wide(from_mm);
    Vec2d const motion = wide(motion_mm);
    std::optional<WallTouch> first;
    for_each_edge(box_around(from_mm, from_mm + motion_mm, radius_mm), [&](WallEdge const& edge) {
        Wall const wall(edge.from, edge.to);
        double const fraction = wall.touch(from, motion, radius_mm);
        if (fraction <= 1.0 && (!first || fraction < first->fraction)) {
            Vec2d const normal = wall.normal_at(from + fraction * motion);
            first = WallTouch{fraction, {static_cast<float>(normal.x), static_cast<float>(normal.y)}};
        }
    });
    return first;
}

}  // namespace pogosim
