#include "physics/hulls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pogosim {

namespace {

// The search for the first touch ends at this distance, or after this many steps along the motion.
constexpr float kTouchMm = 0.01F;
constexpr int kMostSteps = 64;

}  // namespace

Hulls::Hulls(World const& world) {
    Bodies const& bodies = world.bodies;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        Shape const& shape = bodies.shape[i];
        if (shape.kind == ShapeKind::disk) {
            continue;
        }
        parts_.resize(bodies.size());
        std::vector<RoundedPolygon> const parts = convex_parts(shape);
        parts_[i] = {static_cast<std::uint32_t>(hulls_.size()), static_cast<std::uint32_t>(parts.size())};
        for (RoundedPolygon const& part : parts) {
            Hull hull = hull_of(part);
            hull.centre_mm = parts.size() > 1 ? moments_of(part).centre_mm() : Vec2{};
            for (std::uint32_t k = 0; k < hull.count; ++k) {
                hull.reach_mm = std::max(hull.reach_mm, length(hull.corner_mm[k] - hull.centre_mm) + hull.radius_mm);
            }
            hulls_.push_back(hull);
        }
    }
}

Hull Hulls::of(World const& world, std::uint32_t body, std::uint32_t part) const {
    if (is_one(body)) {
        return hulls_[parts_[body].first + part];
    }
    Hull disk;
    disk.count = 1;
    disk.radius_mm = world.bodies.radius_mm[body];
    disk.reach_mm = disk.radius_mm;
    return disk;
}

Gap Hulls::gap_to(World const& world, std::uint32_t body, std::uint32_t part, Vec2 point_mm) const {
    Vec2 const ahead = world.bodies.heading_dir[body];
    Vec2 const aside{-ahead.y, ahead.x};
    Vec2 const way_mm = minimum_image(world, world.bodies.position_mm[body], point_mm);
    Vec2 const place_mm{dot(way_mm, ahead), dot(way_mm, aside)};
    // From the side with the largest signed distance, or, in front of a corner, from the nearest point of a side.
    Gap inside{-std::numeric_limits<float>::max(), {}};
    Gap outside{std::numeric_limits<float>::max(), {}};
    Hull const& hull = hulls_[parts_[body].first + part];
    for (std::uint32_t i = 0; i < hull.count; ++i) {
        Vec2 const outwards = hull.outwards[i];
        Vec2 const along{-outwards.y, outwards.x};
        Vec2 const offset_mm = place_mm - hull.corner_mm[i];
        float const height_mm = dot(offset_mm, outwards);
        if (height_mm > inside.distance_mm) {
            inside = {height_mm, outwards};
        }
        float const length_mm = length(hull.next_corner_mm(i) - hull.corner_mm[i]);
        float const t_mm = std::clamp(dot(offset_mm, along), 0.0F, length_mm);
        Vec2 const out_mm = offset_mm - t_mm * along;
        float const far_mm = length(out_mm);
        if (height_mm > 0.0F && far_mm < outside.distance_mm) {
            outside = {far_mm, (1.0F / far_mm) * out_mm};
        }
    }
    Gap const& gap = inside.distance_mm > 0.0F ? outside : inside;
    return {gap.distance_mm - hull.radius_mm, gap.normal.x * ahead + gap.normal.y * aside};
}

/// Sphere tracing, in steps of the distance to the nearest side: J. C. Hart, "Sphere tracing", The Visual Computer 12
/// (1996) 527.
float Hulls::fraction_to_touch(World const& world, std::uint32_t body, std::uint32_t part, Vec2 from_mm, Vec2 motion_mm,
                               float radius_mm) const {
    float const motion_length_mm = length(motion_mm);
    float gone_mm = 0.0F;
    for (int step = 0; step < kMostSteps && gone_mm < motion_length_mm; ++step) {
        Vec2 const place_mm = from_mm + (gone_mm / motion_length_mm) * motion_mm;
        float const free_mm = gap_to(world, body, part, place_mm).distance_mm - radius_mm;
        if (free_mm < kTouchMm) {
            return step == 0 ? 1.0F : gone_mm / motion_length_mm;
        }
        gone_mm += free_mm;
    }
    return 1.0F;
}

}  // namespace pogosim
