// What a soft membrane encloses: it resists changes of its area like a cushion of water.
#pragma once

#include <vector>

#include "physics/box2d_units.hpp"
#include "world/world.hpp"

namespace pogosim {

/// A spring between the present and the initial area of a membrane, with the membrane's own mass, critically damped.
/// Solved as one soft constraint per step, which is stable at every stiffness: E. Catto, "Soft Constraints", Game
/// Developers Conference, 2011.
class MembraneArea {
public:
    /// `bodies` are all of the world; the membrane's are at rest.
    MembraneArea(Membrane const& membrane, std::vector<b2Body*> const& bodies);

    /// Changes the velocities for a step of `dt_s`.
    void push(float dt_s) const;

private:
    std::vector<b2Body*> bodies_;
    float area_;  // at rest, units^2
};

}  // namespace pogosim
