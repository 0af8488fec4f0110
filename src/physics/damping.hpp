// Linear damping of velocities: dv/dt = -c v, so that a body alone slows down exponentially, exactly.
#pragma once

#include <vector>

#include "world/world.hpp"

namespace pogosim {

class Damping {
public:
    explicit Damping(Bodies const& bodies);

    /// Makes the velocities the means of those in the step to come, so that bodies moved by them go as far as they
    /// should.
    void begin_step(Bodies& bodies, float dt_s);

    /// Makes them those at the end of the step.
    void end_step(Bodies& bodies) const;

private:
    /// In parts of the velocity at the start of a step.
    struct Decay {
        float mean = 1.0F;  // in the step
        float rest = 1.0F;  // at its end, in parts of the mean
    };

    static Decay decay(float damping_per_s, float dt_s);
    void multiply(Bodies& bodies, float Decay::*by) const;

    bool is_damped_;  // some body
    float dt_s_ = 0.0F;
    std::vector<Decay> linear_;
    std::vector<Decay> angular_;
};

}  // namespace pogosim
