#include "world/observed_motion.hpp"

#include <algorithm>
#include <cmath>

namespace pogosim {

namespace {

/// Digits that the difference of two coordinates loses: a few roundings of each, as of an engine's sub-steps.
constexpr float kRounding = 5e-7F;

/// A change of a coordinate by the time that it took. The engine's own number where it says the same: it has more
/// digits.
float rate(float change, float duration_s, float largest, float of_engine) {
    bool const is_as_asked = std::abs(change - duration_s * of_engine) <= kRounding * largest;
    return is_as_asked ? of_engine : change / duration_s;
}

}  // namespace

ObservedMotion observed_motion(World const& world, std::uint32_t body) {
    Bodies const& bodies = world.bodies;
    auto const step_s = static_cast<float>(world.time_step_s);
    Vec2 const start_mm = bodies.start_mm[body];
    Vec2 const end_mm = bodies.position_mm[body];
    Vec2 const moved_mm = minimum_image(world, start_mm, end_mm);
    float const start_rad = bodies.start_rad[body];
    float const end_rad = bodies.heading_rad[body];
    Vec2 const velocity_mm_s = bodies.velocity_mm_s[body];
    auto const larger = [](float a, float b) { return std::max(std::abs(a), std::abs(b)); };
    if (moved_mm == Vec2{} && start_rad == end_rad) {
        return {};
    }
    return {.velocity_mm_s = {rate(moved_mm.x, step_s, larger(start_mm.x, end_mm.x), velocity_mm_s.x),
                              rate(moved_mm.y, step_s, larger(start_mm.y, end_mm.y), velocity_mm_s.y)},
            .angular_velocity_rad_s =
                rate(end_rad - start_rad, step_s, larger(start_rad, end_rad), bodies.angular_velocity_rad_s[body])};
}

ObservedMotion observed_motion(World const& world, Object const& object) {
    if (object.body == kNone) {
        return {};
    }
    if (object.body_count == 1) {
        return observed_motion(world, object.body);
    }
    ObservedMotion mean;
    for (std::uint32_t i = object.body; i < object.body + object.body_count; ++i) {
        mean.velocity_mm_s = mean.velocity_mm_s + observed_motion(world, i).velocity_mm_s;
    }
    mean.velocity_mm_s = (1.0F / static_cast<float>(object.body_count)) * mean.velocity_mm_s;
    return mean;
}

}  // namespace pogosim
