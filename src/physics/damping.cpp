#include "physics/damping.hpp"

#include <algorithm>

#include "base/exact_math.hpp"

namespace pogosim {

Damping::Damping(Bodies const& bodies)
    : is_damped_(std::ranges::any_of(bodies.spec, [](BodySpec const& spec) {
          return spec.linear_damping != 0.0F || spec.angular_damping != 0.0F;
      })) {}

Damping::Decay Damping::decay(float damping_per_s, float dt_s) {
    double const x = static_cast<double>(damping_per_s) * static_cast<double>(dt_s);
    if (x == 0.0) {
        return {};
    }
    double const rest = exact::exp(-x);
    // (1 - exp(-x)) / x; its series where the difference has few digits.
    double const mean = x > 1e-3 ? (1.0 - rest) / x : 1.0 - x / 2 * (1.0 - x / 3);
    return {static_cast<float>(mean), static_cast<float>(rest / mean)};
}

void Damping::begin_step(Bodies& bodies, float dt_s) {
    if (!is_damped_) {
        return;
    }
    if (dt_s != dt_s_) {
        dt_s_ = dt_s;
        linear_.clear();
        angular_.clear();
        for (BodySpec const& spec : bodies.spec) {
            linear_.push_back(decay(spec.linear_damping, dt_s));
            angular_.push_back(decay(spec.angular_damping, dt_s));
        }
    }
    multiply(bodies, &Decay::mean);
}

void Damping::end_step(Bodies& bodies) const {
    if (is_damped_) {
        multiply(bodies, &Decay::rest);
    }
}

void Damping::multiply(Bodies& bodies, float Decay::*by) const {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        bodies.velocity_mm_s[i] = linear_[i].*by * bodies.velocity_mm_s[i];
        bodies.angular_velocity_rad_s[i] *= angular_[i].*by;
    }
}

}  // namespace pogosim
