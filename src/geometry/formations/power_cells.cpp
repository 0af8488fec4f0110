#include "geometry/formations/power_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pogosim {

namespace {

constexpr std::size_t kPointsPerLeaf = 48;  // at most, on average
constexpr int kMostLevels = 10;
constexpr std::uint32_t kAtATime = 32;  // points whose sites are found together
constexpr float kDoubt = 1.0e-5F;       // of squared lengths: their rounding is far below

/// Which of 2^levels equal intervals of a range a value is in.
std::uint32_t interval_of(float value, float min, float size, int levels) {
    auto const count = static_cast<float>(1U << static_cast<unsigned>(levels));
    float const place = size > 0.0F ? (value - min) / size * count : 0.0F;
    return static_cast<std::uint32_t>(std::clamp(place, 0.0F, count - 1.0F));
}

/// The lower 16 bits, with a 0 before each.
std::uint32_t spread_bits(std::uint32_t value) {
    value = (value | value << 8U) & 0x00FF00FFU;
    value = (value | value << 4U) & 0x0F0F0F0FU;
    value = (value | value << 2U) & 0x33333333U;
    return (value | value << 1U) & 0x55555555U;
}

/// The number of a leaf: the bits of row and column in turn.
std::uint32_t morton(std::uint32_t column, std::uint32_t row) {
    return spread_bits(row) << 1U | spread_bits(column);
}

/// A quarter of a box, in Morton order.
Box quarter(Box const& box, std::uint32_t number) {
    Vec2 const middle = box.centre();
    Box part = box;
    ((number & 1U) != 0 ? part.min.x : part.max.x) = middle.x;
    ((number & 2U) != 0 ? part.min.y : part.max.y) = middle.y;
    return part;
}

}  // namespace

struct PowerCells::Search {
    struct Candidate {
        Vec2 place_mm;
        float weight_mm2;
        std::uint32_t site;

        float power(Vec2 point_mm) const { return squared_length(place_mm - point_mm) - weight_mm2; }
    };

    std::vector<Candidate> candidates;  // of the parts of the tree that are being looked at, and room for more
    std::vector<PointSum> sums;

    /// The nearest of a point among the candidates from `first` to `end`.
    Candidate const& nearest(Vec2 point_mm, std::size_t first, std::size_t end) const {
        std::size_t best = first;
        float least = candidates[first].power(point_mm);
        for (std::size_t i = first + 1; i < end; ++i) {
            float const own = candidates[i].power(point_mm);
            best = own < least ? i : best;
            least = std::min(own, least);
        }
        return candidates[best];
    }

    /// Adds up to kAtATime points, each to the cell of the nearest of the candidates from `first` to `end`. The nearest
    /// ones of several points are found at once, by vector instructions; then the points are added one by one.
    void add_points(std::span<Vec2 const> points_mm, std::size_t first, std::size_t end) {
        std::array<float, kAtATime> x_mm;
        std::array<float, kAtATime> y_mm;
        std::array<float, kAtATime> least;
        std::array<std::uint32_t, kAtATime> best;
        std::size_t const count = points_mm.size();
        for (std::size_t i = 0; i < count; ++i) {
            x_mm[i] = points_mm[i].x;
            y_mm[i] = points_mm[i].y;
        }
        Candidate const start = candidates[first];
        for (std::size_t i = 0; i < count; ++i) {
            least[i] = start.power({x_mm[i], y_mm[i]});
            best[i] = start.site;
        }
        for (std::size_t c = first + 1; c < end; ++c) {
            Candidate const candidate = candidates[c];
            for (std::size_t i = 0; i < count; ++i) {
                float const own = candidate.power({x_mm[i], y_mm[i]});
                best[i] = own < least[i] ? candidate.site : best[i];
                least[i] = std::min(own, least[i]);
            }
        }
        for (std::size_t i = 0; i < count; ++i) {
            sums[best[i]].add({.x_mm = x_mm[i], .y_mm = y_mm[i], .count = 1});
        }
    }

    /// Repeats, from `end` on, the candidates from `first` to `end` that may be the nearest of a point in a box.
    /// Returns where these end.
    std::size_t keep_near(Box const& box_mm, std::size_t first, std::size_t end) {
        if (candidates.size() < 2 * end - first) {  // at most
            candidates.resize(2 * end - first);
        }
        Vec2 const centre = box_mm.centre();
        Vec2 const half = 0.5F * box_mm.size();
        Candidate const best = nearest(centre, first, end);
        Vec2 const to_best = best.place_mm - centre;
        float const best_power = best.power(centre);
        float const doubt_of_best = kDoubt * (squared_length(to_best) + squared_length(half));
        std::size_t kept = end;
        for (std::size_t i = first; i < end; ++i) {
            Candidate const own = candidates[i];
            Vec2 const to_site = own.place_mm - centre;
            Vec2 const apart = to_site - to_best;
            // The difference of the powers is linear in the point, so it is least in a corner.
            float const most_gained = 2.0F * (half.x * std::fabs(apart.x) + half.y * std::fabs(apart.y));
            float const doubt = doubt_of_best + kDoubt * (squared_length(to_site) + own.weight_mm2);
            candidates[kept] = own;
            kept += own.power(centre) - best_power - most_gained <= doubt ? 1 : 0;
        }
        return kept;
    }
};

PowerCells::PowerCells(Box const& bounds_mm, std::span<Vec2 const> points_mm)
    : bounds_mm_(bounds_mm), points_mm_(points_mm.size()) {
    int depth = 0;
    while (depth < kMostLevels && kPointsPerLeaf << static_cast<unsigned>(2 * depth) < points_mm.size()) {
        ++depth;
    }
    std::vector<std::uint32_t> leaf_of;
    leaf_of.reserve(points_mm.size());
    std::vector<Node> leaves(std::size_t{1} << static_cast<unsigned>(2 * depth));
    Vec2 const size = bounds_mm.size();
    for (Vec2 const point : points_mm) {
        std::uint32_t const leaf = morton(interval_of(point.x, bounds_mm.min.x, size.x, depth),
                                          interval_of(point.y, bounds_mm.min.y, size.y, depth));
        leaf_of.push_back(leaf);
        leaves[leaf].sum.add({.x_mm = point.x, .y_mm = point.y, .count = 1});
    }
    std::uint32_t next = 0;
    for (Node& leaf : leaves) {
        leaf.first = leaf.end = next;
        next += static_cast<std::uint32_t>(leaf.sum.count);
    }
    for (std::size_t i = 0; i < points_mm.size(); ++i) {
        points_mm_[leaves[leaf_of[i]].end++] = points_mm[i];
    }
    levels_.resize(static_cast<std::size_t>(depth) + 1);
    levels_.back() = std::move(leaves);
    for (std::size_t above = levels_.size() - 1; above-- > 0;) {
        std::vector<Node> const& parts = levels_[above + 1];
        levels_[above].resize(parts.size() / 4);
        for (std::size_t i = 0; i < levels_[above].size(); ++i) {
            Node& node = levels_[above][i];
            node.first = parts[4 * i].first;
            node.end = parts[4 * i + 3].end;
            for (std::size_t part = 4 * i; part < 4 * i + 4; ++part) {
                node.sum.add(parts[part].sum);
            }
        }
    }
}

void PowerCells::visit(Search& search, int number, std::uint32_t place, Box const& box_mm, std::size_t first_candidate,
                       std::size_t end_candidate) const {
    Node const& node = level(number)[place];
    if (node.sum.count == 0) {
        return;
    }
    std::size_t const first = end_candidate;  // of those that are kept
    std::size_t const end = search.keep_near(box_mm, first_candidate, end_candidate);
    if (end - first == 1) {
        search.sums[search.candidates[first].site].add(node.sum);
    } else if (static_cast<std::size_t>(number) + 1 == levels_.size()) {
        for (std::uint32_t i = node.first; i < node.end; i += kAtATime) {
            search.add_points(std::span(points_mm_).subspan(i, std::min(kAtATime, node.end - i)), first, end);
        }
    } else {
        for (std::uint32_t part = 0; part < 4; ++part) {
            visit(search, number + 1, 4 * place + part, quarter(box_mm, part), first, end);
        }
    }
}

std::vector<PointSum> PowerCells::sums(std::span<Vec2 const> sites_mm, std::span<float const> weights_mm2) const {
    Search search;
    search.sums.resize(sites_mm.size());
    search.candidates.reserve(4 * sites_mm.size());
    for (std::uint32_t site = 0; site < sites_mm.size(); ++site) {
        search.candidates.push_back({.place_mm = sites_mm[site], .weight_mm2 = weights_mm2[site], .site = site});
    }
    visit(search, 0, 0, bounds_mm_, 0, sites_mm.size());
    return std::move(search.sums);
}

}  // namespace pogosim
