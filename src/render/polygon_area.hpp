// The exact area of each pixel that polygons cover.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "render/canvas.hpp"

namespace pogosim {

/// Rows of `box` that are worked on at once, so that a large picture takes little memory.
inline int rows_at_once(PixelBox const& box) {
    constexpr int kMostPixels = 1 << 20;
    return std::clamp(kMostPixels / std::max(box.width() + 2, 1), 1, std::max(box.height(), 1));
}

/// Accumulates signed areas as font rasterizers do (S. Barrett, "How the stb_truetype Anti-Aliased Software Rasterizer
/// v2 Works", 2014; R. Levien, "Inside the fastest font renderer in the world", 2016): each edge leaves, in every row,
/// the change of the covered area from one pixel to the next, and the sum along a row is the area covered.
class PolygonArea {
public:
    /// `area` is scratch memory that can be used again.
    PolygonArea(PixelBox const& box, std::vector<float>& area) : box_(box), stride_(box.width() + 2), area_(area) {
        area_.assign(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(box.height()), 0.0F);
    }

    void add(std::span<Vec2 const> polygon) {
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            add_edge(polygon[i], polygon[i + 1 == polygon.size() ? 0 : i + 1]);
        }
    }

    /// Calls paint(y, from the left of the box, coverage 0 to 1) for every pixel with some coverage.
    template <class Paint>
    void for_each_covered(Paint const& paint) const {
        for (int y = 0; y < box_.height(); ++y) {
            float const* const change = area_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(stride_);
            float sum = 0.0F;
            for (int x = 0; x < box_.width(); ++x) {
                sum += change[x];
                float const coverage = std::min(std::abs(sum), 1.0F);
                if (coverage > 1e-3F) {
                    paint(box_.top + y, x, coverage);
                }
            }
        }
    }

private:
    void add_edge(Vec2 from, Vec2 to) {
        double x0 = static_cast<double>(from.x) - box_.left;
        double y0 = static_cast<double>(from.y) - box_.top;
        double x1 = static_cast<double>(to.x) - box_.left;
        double y1 = static_cast<double>(to.y) - box_.top;
        if (y0 == y1 || !std::isfinite(x0 + y0 + x1 + y1)) {
            return;
        }
        double const sign = y0 < y1 ? 1.0 : -1.0;
        if (y0 > y1) {
            std::swap(x0, x1);
            std::swap(y0, y1);
        }
        double const slope = (x1 - x0) / (y1 - y0);
        double const top = std::max(y0, 0.0);
        double const bottom = std::min(y1, static_cast<double>(box_.height()));
        if (!(top < bottom)) {
            return;
        }
        for (int y = static_cast<int>(top); y < bottom; ++y) {
            double const high = std::max(top, static_cast<double>(y));
            double const low = std::min(bottom, static_cast<double>(y) + 1.0);
            add_to_row(y, x0 + slope * (high - y0), x0 + slope * (low - y0), sign * (low - high));
        }
    }

    /// The part of an edge in one row, over a signed height of at most 1.
    void add_to_row(int y, double from, double to, double height) {
        double const left = std::min(from, to);
        double const right = std::max(from, to);
        auto const end = static_cast<double>(box_.width());
        float* const change = area_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(stride_);
        if (right <= left) {  // upright
            leave(change, std::clamp(left, 0.0, end), height);
            return;
        }
        // Left of the box an edge counts as its left side, right of the box it covers nothing.
        double const per_column = height / (right - left);
        if (left < 0.0) {
            leave(change, 0.0, per_column * (std::min(right, 0.0) - left));
        }
        double const last = std::min(right, end);
        for (double x = std::max(left, 0.0); x < last;) {
            double const next = std::min(std::floor(x) + 1.0, last);
            auto const column = static_cast<int>(x);
            auto const share = static_cast<float>(per_column * (next - x));
            auto const covered = static_cast<float>(1.0 - (0.5 * (x + next) - std::floor(x)));
            change[column] += share * covered;
            change[column + 1] += share * (1.0F - covered);
            x = next;
        }
    }

    /// An upright piece at x, in [0, width].
    static void leave(float* change, double x, double height) {
        auto const column = static_cast<int>(x);
        auto const beside = static_cast<float>(x - column);
        change[column] += static_cast<float>(height) * (1.0F - beside);
        change[column + 1] += static_cast<float>(height) * beside;
    }

    PixelBox box_;
    int stride_;
    std::vector<float>& area_;
};

}  // namespace pogosim
