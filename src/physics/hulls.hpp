// The bodies that are not disks, fixed ones and movable ones. Each is one convex hull or, a compound, several.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/hull.hpp"
#include "physics/wall_side.hpp"
#include "world/world.hpp"

namespace pogosim {

class Hulls {
public:
    explicit Hulls(World const& world);

    bool empty() const { return hulls_.empty(); }
    /// Whether a body is no disk.
    bool is_one(std::uint32_t body) const { return !parts_.empty() && parts_[body].count > 0; }

    /// Number of convex parts; more than one for compounds only.
    std::uint32_t part_count(std::uint32_t body) const { return is_one(body) ? parts_[body].count : 1; }

    /// In the body's own frame. A disk is a hull with one corner.
    Hull of(World const& world, std::uint32_t body, std::uint32_t part) const;

    /// The disk around a part of a body, in the body's own frame.
    struct Around {
        Vec2 centre_mm;
        float radius_mm;
    };
    Around around(World const& world, std::uint32_t body, std::uint32_t part) const {
        if (!is_one(body)) {
            return {{}, world.bodies.radius_mm[body]};
        }
        Hull const& hull = hulls_[parts_[body].first + part];
        return {hull.centre_mm, hull.reach_mm};
    }

    /// Gap between a point and a part of a body that is a hull, whose pose is read from the world: negative inside,
    /// where the normal points out through the nearest side.
    Gap gap_to(World const& world, std::uint32_t body, std::uint32_t part, Vec2 point_mm) const;

    /// The fraction of its motion after which a disk touches a part of a fixed body; 1 if it never does, or touches it
    /// at the start.
    float fraction_to_touch(World const& world, std::uint32_t body, std::uint32_t part, Vec2 from_mm, Vec2 motion_mm,
                            float radius_mm) const;

private:
    /// Where the parts of a body are in hulls_; none: it is a disk.
    struct Parts {
        std::uint32_t first = 0;
        std::uint32_t count = 0;
    };

    std::vector<Hull> hulls_;
    std::vector<Parts> parts_;  // of each body. Empty if all are disks
};

}  // namespace pogosim
