#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "geometry/formations/ring_placement.hpp"

namespace pogosim {

namespace {

// Objects without a size stand this far apart.
constexpr float kLeastSpacingMm = 1.0F;

constexpr float kContactMargin = 1.0005F;  // rounding must not turn contact into overlap

constexpr float kHalfRoot3 = 0.866025404F;

/// One side of a ring: its corner, where the ring comes from, and the step from node to node.
struct Side {
    Vec2 corner;  // of ring 1
    Vec2 step;
};

// Both are walked clockwise on the screen. In units of the spacing.
constexpr std::array<Side, 6> kHexagon{{
    {{1.0F, 0.0F}, {-0.5F, kHalfRoot3}},
    {{0.5F, kHalfRoot3}, {-1.0F, 0.0F}},
    {{-0.5F, kHalfRoot3}, {-0.5F, -kHalfRoot3}},
    {{-1.0F, 0.0F}, {0.5F, -kHalfRoot3}},
    {{-0.5F, -kHalfRoot3}, {1.0F, 0.0F}},
    {{0.5F, -kHalfRoot3}, {0.5F, kHalfRoot3}},
}};
constexpr std::array<Side, 4> kSquare{{
    {{1.0F, -1.0F}, {0.0F, 1.0F}},
    {{1.0F, 1.0F}, {-1.0F, 0.0F}},
    {{-1.0F, 1.0F}, {0.0F, -1.0F}},
    {{-1.0F, -1.0F}, {1.0F, 0.0F}},
}};

std::span<Side const> sides_of(LatticeKind kind) {
    return kind == LatticeKind::triangular ? std::span<Side const>(kHexagon) : std::span<Side const>(kSquare);
}

/// Nodes of a ring, each next to the one before, in units of the spacing. They begin behind the first corner and end on
/// it, so the rings up to any node have as many pairs of neighbours as that number of nodes can have: F. Harary and
/// H. Harborth, "Extremal animals", J. Combin. Inform. System Sci. 1, 1, 1976.
std::vector<Vec2> ring_of(LatticeKind kind, int ring) {
    if (ring == 0) {
        return {{}};
    }
    std::span<Side const> const sides = sides_of(kind);
    auto const size = static_cast<float>(ring);
    // Nodes from one corner to the next one.
    int const count = kind == LatticeKind::triangular ? ring : 2 * ring;
    std::vector<Vec2> nodes;
    for (auto const& [corner, step] : sides) {
        for (int i = 1; i <= count; ++i) {
            nodes.push_back(size * corner + static_cast<float>(i) * step);
        }
    }
    return nodes;
}

/// Middle of so many nodes of a square lattice, in units of the spacing: an even number of rows has none in its middle.
/// A triangular patch is symmetric about its first node.
Vec2 middle_of(LatticeKind kind, std::size_t count) {
    Box box{};
    for (int ring = 0; kind == LatticeKind::square && count > 0; ++ring) {
        for (Vec2 const node : ring_of(kind, ring)) {
            box.min = {std::min(box.min.x, node.x), std::min(box.min.y, node.y)};
            box.max = {std::max(box.max.x, node.x), std::max(box.max.y, node.y)};
            if (--count == 0) {
                break;
            }
        }
    }
    return box.centre();
}

float least_spacing(float largest_mm) {
    return 2.0F * kContactMargin * largest_mm;
}

}  // namespace

float lattice_spacing(FormationSpec const& spec, float largest_mm) {
    return spec.lattice_spacing_mm.value_or(std::max(least_spacing(largest_mm), kLeastSpacingMm));
}

std::vector<Placement> place_lattice(PlacementTask const& task) {
    LatticeKind const kind = task.spec.lattice_kind;
    float const largest_mm = *std::ranges::max_element(task.radii_mm);
    float const spacing_mm = lattice_spacing(task.spec, largest_mm);
    if (spacing_mm < least_spacing(largest_mm)) {
        throw FormationError(kLatticeSpacingKey,
                             fmt::format("{:g} mm is too little for {}; it must be at least {:.4g} mm", spacing_mm,
                                         describe_objects(task), least_spacing(largest_mm)));
    }
    Vec2 const first = formation_centre(task) - spacing_mm * middle_of(kind, task.radii_mm.size());
    auto const nodes = [&](int ring) {
        std::vector<Vec2> places = ring_of(kind, ring);
        std::ranges::for_each(places, [&](Vec2& place) { place = first + spacing_mm * place; });
        return places;
    };
    float const step_mm = kind == LatticeKind::triangular ? kHalfRoot3 * spacing_mm : spacing_mm;
    return place_on_rings(
        task, first,
        [&](float) {
            return RingPattern{step_mm, nodes};
        },
        fmt::format("reduce nb, lower {}, or {}", kLatticeSpacingKey, task.remedy));
}

}  // namespace pogosim
