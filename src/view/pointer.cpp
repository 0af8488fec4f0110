#include "view/pointer.hpp"

#include <limits>

namespace pogosim {

namespace {

/// From the point to the nearest part of an object that covers it; infinite when none does.
float distance_to(Snapshot const& snapshot, Object const& object, Vec2 point_mm, float margin_mm) {
    float nearest_mm = std::numeric_limits<float>::infinity();
    if (object.body == kNone) {
        return nearest_mm;
    }
    for (std::uint32_t body = object.body; body < object.body + object.body_count; ++body) {
        float const distance_mm = length(snapshot.position_mm[body] - point_mm);
        bool const covers = distance_mm <= snapshot.scenery->body_radius_mm[body] + margin_mm;
        nearest_mm = covers ? std::min(nearest_mm, distance_mm) : nearest_mm;
    }
    return nearest_mm;
}

template <class May>
std::optional<std::uint32_t> nearest_object(Snapshot const& snapshot, Vec2 point_mm, float margin_mm, May const& may) {
    std::optional<std::uint32_t> nearest;
    float least_mm = std::numeric_limits<float>::infinity();
    auto const& objects = snapshot.scenery->objects;
    for (std::uint32_t i = 0; i < objects.size(); ++i) {
        float const distance_mm = may(objects[i]) ? distance_to(snapshot, objects[i], point_mm, margin_mm) : least_mm;
        if (distance_mm < least_mm) {
            least_mm = distance_mm;
            nearest = i;
        }
    }
    return nearest;
}

}  // namespace

std::optional<std::uint32_t> robot_at(Snapshot const& snapshot, Vec2 point_mm, float margin_mm) {
    auto const is_robot = [](Object const& object) { return object.robot != kNone; };
    auto const object = nearest_object(snapshot, point_mm, margin_mm, is_robot);
    return object ? std::optional(snapshot.scenery->objects[*object].robot) : std::nullopt;
}

std::optional<std::uint32_t> object_at(Snapshot const& snapshot, Vec2 point_mm, float margin_mm) {
    return nearest_object(snapshot, point_mm, margin_mm, [](Object const&) { return true; });
}

Vec2 centre_of(Snapshot const& snapshot, Object const& object) {
    // From the first one, so that the seam of a periodic arena does not tear a membrane.
    Vec2 const first_mm = snapshot.position_mm[object.body];
    Vec2 sum_mm;
    for (std::uint32_t body = object.body; body < object.body + object.body_count; ++body) {
        sum_mm = sum_mm + minimum_image(*snapshot.scenery, first_mm, snapshot.position_mm[body]);
    }
    return first_mm + (1.0F / static_cast<float>(object.body_count)) * sum_mm;
}

}  // namespace pogosim
