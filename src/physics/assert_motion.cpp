#include "physics/assert_motion.hpp"

#include <cassert>
#include <cmath>
#include <cstdint>

#ifndef NDEBUG
namespace pogosim {

namespace {

constexpr float kTolerance = 1e-3F;  // of the length of a unit vector

}  // namespace

void assert_motion(Bodies const& bodies) {
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        assert(is_finite(bodies.position_mm[i]) && std::isfinite(bodies.heading_rad[i]));
        assert(is_finite(bodies.velocity_mm_s[i]) && std::isfinite(bodies.angular_velocity_rad_s[i]));
        assert(length(bodies.heading_dir[i] - direction(bodies.heading_rad[i])) < kTolerance);
        assert(!bodies.spec[i].fixed || bodies.velocity_mm_s[i] == Vec2{});
        assert(!bodies.spec[i].fixed || bodies.angular_velocity_rad_s[i] == 0.0F);
    }
}

}  // namespace pogosim
#endif
