// What stands in an arena already: quick answers for many points.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/formations/band_index.hpp"
#include "geometry/obstacle.hpp"

namespace pogosim {

/// A point is pushed this much further than its clearance, so that rounding does not leave it short of that.
inline constexpr float kPushMargin = 1.0005F;

class ObstacleField {
public:
    ObstacleField(std::span<Obstacle const> obstacles, Box bounds_mm);

    bool empty() const { return edges_.empty(); }

    /// True when a disk of this radius here overlaps none.
    bool is_clear(Vec2 centre_mm, float radius_mm) const;

    /// Where the disk stands next to the obstacle that it is nearest to or in; nothing when it is clear of all.
    std::optional<Vec2> pushed_off(Vec2 centre_mm, float radius_mm) const;

private:
    struct Edge {
        Vec2 from;
        Vec2 to;
        float half_thickness_mm;
        bool solid;
    };

    void add_edges(Obstacle const& obstacle);
    bool is_enclosed(Vec2 point) const;
    static Vec2 beside(Edge const& edge, Vec2 point, float radius_mm, bool across);
    std::optional<Vec2> pushed_out(Vec2 centre, float radius_mm) const;

    std::vector<Edge> edges_;  // around solid ones clockwise on the screen
    BandIndex bands_;          // with their thickness
};

}  // namespace pogosim
