// Moves the bodies. A small interface, so that another engine is one more file.
#pragma once

#include <memory>

#include "world/world.hpp"

namespace pogosim {

class PhysicsEngine {
public:
    virtual ~PhysicsEngine() = default;

    /// Imposes fresh drives, advances all bodies by one time step and writes their poses and velocities back.
    virtual void advance(World& world) = 0;

    /// Puts an object that has a body elsewhere, at rest and awake, whether it is fixed or not: a rigid body with its
    /// centre at `centre_mm` and with this heading, a ring as it is with its middle there. Writes that to the world,
    /// too. Bodies that overlap then are pushed apart in the next steps. The place is free of walls: see FreePlaces.
    virtual void set_pose(World& world, Object const& object, Vec2 centre_mm, float heading_rad) = 0;
};

/// What the engine can follow in one time step: some 20 m and 25 turns, and no more than its soft rings can hold back.
struct MotionLimits {
    float motion_mm;
    float turn_rad;
    bool is_of_rings;  // motion_mm
};
MotionLimits box2d_motion_limits(World const& world);

/// Box2D behind the interface. Takes the arena and the bodies, with poses and velocities, as they are in the world now.
/// Throws ConfigError when the arena is too small to build walls.
std::unique_ptr<PhysicsEngine> make_box2d_engine(World const& world, WallSpec const& walls);

}  // namespace pogosim
