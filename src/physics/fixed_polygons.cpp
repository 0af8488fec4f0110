#include "physics/fixed_polygons.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pogosim {

namespace {

// The search for the first touch ends at this distance, or after this many steps along the motion.
constexpr float kTouchMm = 0.01F;
constexpr int kMostSteps = 64;

}  // namespace

FixedPolygons::FixedPolygons(World const& world) {
    Bodies const& bodies = world.bodies;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (!bodies.spec[i].fixed || bodies.shape[i].kind == ShapeKind::disk) {
            continue;
        }
        polygons_.resize(bodies.size());
        pogosim::Polygon const corners = outline(bodies.shape[i]);
        polygons_[i] = {static_cast<std::uint32_t>(sides_.size()), static_cast<std::uint32_t>(corners.size())};
        for (std::size_t k = 0; k < corners.size(); ++k) {
            Vec2 const from_mm = corners[k];
            Vec2 const way_mm = corners[(k + 1) % corners.size()] - from_mm;
            float const length_mm = length(way_mm);
            Vec2 const along = length_mm > 0.0F ? (1.0F / length_mm) * way_mm : Vec2{1.0F, 0.0F};
            sides_.push_back({from_mm, along, {along.y, -along.x}, length_mm});  // clockwise on the screen
        }
    }
}

Gap FixedPolygons::gap_to(World const& world, std::uint32_t body, Vec2 point_mm) const {
    Vec2 const ahead = world.bodies.heading_dir[body];
    Vec2 const aside{-ahead.y, ahead.x};
    Vec2 const way_mm = minimum_image(world, world.bodies.position_mm[body], point_mm);
    Vec2 const place_mm{dot(way_mm, ahead), dot(way_mm, aside)};
    // From the side with the largest signed distance, or, in front of a corner, from the nearest point of a side.
    Gap inside{-std::numeric_limits<float>::max(), {}};
    Gap outside{std::numeric_limits<float>::max(), {}};
    Polygon const& polygon = polygons_[body];
    for (std::uint32_t i = polygon.first; i < polygon.first + polygon.count; ++i) {
        Side const& side = sides_[i];
        Vec2 const offset_mm = place_mm - side.from_mm;
        float const height_mm = dot(offset_mm, side.outwards);
        if (height_mm > inside.distance_mm) {
            inside = {height_mm, side.outwards};
        }
        float const t_mm = std::clamp(dot(offset_mm, side.along), 0.0F, side.length_mm);
        Vec2 const out_mm = offset_mm - t_mm * side.along;
        float const far_mm = length(out_mm);
        if (height_mm > 0.0F && far_mm < outside.distance_mm) {
            outside = {far_mm, (1.0F / far_mm) * out_mm};
        }
    }
    Gap const& gap = inside.distance_mm > 0.0F ? outside : inside;
    return {gap.distance_mm, gap.normal.x * ahead + gap.normal.y * aside};
}

/// Sphere tracing, in steps of the distance to the nearest side: J. C. Hart, "Sphere tracing", The Visual Computer 12
/// (1996) 527.
float FixedPolygons::fraction_to_touch(World const& world, std::uint32_t body, Vec2 from_mm, Vec2 motion_mm,
                                       float radius_mm) const {
    float const motion_length_mm = length(motion_mm);
    float gone_mm = 0.0F;
    for (int step = 0; step < kMostSteps && gone_mm < motion_length_mm; ++step) {
        Vec2 const place_mm = from_mm + (gone_mm / motion_length_mm) * motion_mm;
        float const free_mm = gap_to(world, body, place_mm).distance_mm - radius_mm;
        if (free_mm < kTouchMm) {
            return step == 0 ? 1.0F : gone_mm / motion_length_mm;
        }
        gone_mm += free_mm;
    }
    return 1.0F;
}

}  // namespace pogosim
