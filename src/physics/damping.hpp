// Linear damping of velocities: dv/dt = -c v, so that a body alone slows down exponentially, exactly.
#pragma once

#include <vector>

#include "world/world.hpp"

namespace pogosim {

class Damping {
public:
    explicit Damping(Bodies const& bodies);

    /// Replaces each velocity by its mean over the coming step, so that a body that moves at it covers the exact
    /// distance.
    void begin_step(Bodies& bodies, float dt_s);

    /// Replaces the mean velocities by those at the end of the step.
    void end_step(Bodies& bodies) const;

private:
    /// Factors of the velocity.
    struct Decay {
        float mean = 1.0F;  // mean over the step, relative to its start
        float rest = 1.0F;  // end of the step, relative to the mean
    };

    static Decay decay(float damping_per_s, float dt_s);
    void multiply(Bodies& bodies, float Decay::*by) const;

    bool is_damped_;  // at least one body is
    float dt_s_ = 0.0F;
    std::vector<Decay> linear_;
    std::vector<Decay> angular_;
};

}  // namespace pogosim
