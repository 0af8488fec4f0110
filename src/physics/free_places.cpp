#include "physics/free_places.hpp"

#include <cmath>
#include <optional>

#include "geometry/shape.hpp"

namespace pogosim {

namespace {

constexpr float kTolerance = 0.01F;  // of the inner radius
constexpr int kMostWalls = 3;        // a motion along walls ends at the third one, or in a corner
constexpr float kFarthestMm = 1e6F;  // as of places in configurations

}  // namespace

bool FreePlaces::is_free(Object const& object, Vec2 centre_mm) const {
    Vec2 const motion = centre_mm - pogosim::centre_mm(world_, object);
    if (object.body == kNone) {
        return motion == Vec2{};
    }
    if (std::abs(centre_mm.x) > kFarthestMm || std::abs(centre_mm.y) > kFarthestMm) {
        return false;  // a float would round it to another place of a periodic arena
    }
    for (std::uint32_t body = object.body; !world_.periodic && body < object.body + object.body_count; ++body) {
        Vec2 const place = world_.bodies.position_mm[body] + motion;
        float const needed_mm = (1.0F - kTolerance) * inner_radius(world_.bodies.shape[body]);
        if (!world_.arena.contains(place) || walls_.distance(place, needed_mm) < needed_mm) {
            return false;
        }
    }
    return true;
}

Vec2 FreePlaces::nearest(Object const& object, Vec2 target_mm) const {
    Vec2 const here = centre_mm(world_, object);
    if (is_free(object, target_mm)) {
        return target_mm;
    }
    if (object.body == kNone) {
        return here;
    }
    Vec2 const place = here + slide(object, target_mm - here);
    return is_free(object, place) ? place : here;
}

Vec2 FreePlaces::slide(Object const& object, Vec2 motion_mm) const {
    Vec2 done_mm;
    for (int wall = 0; wall < kMostWalls; ++wall) {
        std::optional<WallTouch> first;
        for (std::uint32_t body = object.body; body < object.body + object.body_count; ++body) {
            auto const touch = walls_.first_touch(world_.bodies.position_mm[body] + done_mm, motion_mm,
                                                  inner_radius(world_.bodies.shape[body]));
            if (touch && (!first || touch->fraction < first->fraction)) {
                first = touch;
            }
        }
        if (!first) {
            return done_mm + motion_mm;
        }
        auto const fraction = static_cast<float>(first->fraction);
        done_mm = done_mm + fraction * motion_mm;
        motion_mm = (1.0F - fraction) * motion_mm;
        motion_mm = motion_mm - dot(motion_mm, first->normal) * first->normal;
    }
    return done_mm;
}

}  // namespace pogosim
