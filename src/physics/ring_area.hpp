// What a soft ring encloses: it resists changes of its area like a cushion of water.
#pragma once

#include <vector>

#include "physics/box2d_units.hpp"
#include "world/world.hpp"

namespace pogosim {

/// A spring between the present and the initial area of a ring, with the ring's own mass, critically damped. Solved as
/// one soft constraint per step, which is stable at every stiffness: E. Catto, "Soft Constraints", Game Developers
/// Conference, 2011.
class RingArea {
public:
    /// `bodies` are all of the world; the ring's are at rest.
    RingArea(Ring const& ring, std::vector<b2Body*> const& bodies);

    /// Changes the velocities for a step of `dt_s`.
    void push(float dt_s) const;

private:
    std::vector<b2Body*> bodies_;
    float area_;  // at rest, units^2
};

}  // namespace pogosim
