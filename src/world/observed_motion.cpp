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

float larger(float a, float b) {
    return std::max(std::abs(a), std::abs(b));
}

float observed_angular_velocity_rad_s(World const& world, std::uint32_t body) {
    Bodies const& bodies = world.bodies;
    float const start_rad = bodies.start_rad[body];
    float const end_rad = bodies.heading_rad[body];
    if (start_rad == end_rad) {
        return 0.0F;
    }
    auto const step_s = static_cast<float>(world.time_step_s);
    float const velocity_rad_s = bodies.angular_velocity_rad_s[body];
    float const expected_rad = step_s * velocity_rad_s;
    // Headings are wrapped: of the turns that lead from one to the other, the one nearest to the engine's.
    float const turned_rad = expected_rad + wrap_angle(end_rad - start_rad - expected_rad);
    return rate(turned_rad, step_s, larger(start_rad, end_rad), velocity_rad_s);
}

}  // namespace

Vec2 observed_velocity_mm_s(World const& world, BodyStep const& step) {
    Vec2 const moved_mm = minimum_image(world, step.start_mm, step.end_mm);
    if (moved_mm == Vec2{}) {
        return {};
    }
    auto const step_s = static_cast<float>(world.time_step_s);
    return {rate(moved_mm.x, step_s, larger(step.start_mm.x, step.end_mm.x), step.engine_mm_s.x),
            rate(moved_mm.y, step_s, larger(step.start_mm.y, step.end_mm.y), step.engine_mm_s.y)};
}

ObservedMotion observed_motion(World const& world, std::uint32_t body) {
    return {.velocity_mm_s = observed_velocity_mm_s(world, last_step(world, body)),
            .angular_velocity_rad_s = observed_angular_velocity_rad_s(world, body)};
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
        mean.velocity_mm_s = mean.velocity_mm_s + observed_velocity_mm_s(world, last_step(world, i));
    }
    mean.velocity_mm_s = (1.0F / static_cast<float>(object.body_count)) * mean.velocity_mm_s;
    return mean;
}

}  // namespace pogosim
