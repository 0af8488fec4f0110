// Keeps bodies on their side of the walls, whatever their speed.
//
// Box2D pushes a body out of a wall only while the body's centre is on the free side: whoever jumps across, or is
// pushed across by a crowd, is gone for good. So the path of each centre is looked at after the engine's step. The path
// is as wide as half the body: a body that has sunk into a wall by more than half its inner radius goes back to where
// it touched the wall, and the rest of its motion runs along the wall.
//
//        wall
//         |      .--.
//     <---|-----(  o )     what the engine did
//         |.--.  '--'
//         (  o )           what remains of it
//         |'--'
//
// Most steps need no look at the walls: each body knows how far it may go before it can have reached one.
#pragma once

#include <vector>

#include "geometry/wall_index.hpp"
#include "physics/box2d_units.hpp"
#include "world/world.hpp"

namespace pogosim {

class Containment {
public:
    /// Takes the bodies where they are in the world now: their centres are inside the arena.
    explicit Containment(World const& world);

    /// To be called after a step of the engine. A body that is put back keeps its velocity: it touches the wall now,
    /// and the engine's next step throws it back. A pose that is not finite becomes the last one, at rest.
    void hold(std::vector<b2Body*> const& bodies);

    /// Takes the bodies where they are now, as the constructor does.
    void start_from(std::vector<b2Body*> const& bodies);

private:
    /// Of one body.
    struct Leash {
        Vec2 last_mm;            // where it was held last
        float free_mm = 0.0F;    // no wall is reached by moving less than this
        float radius_mm = 0.0F;  // of the largest disk around the centre in the shape
    };

    void look_at_walls(b2Body& body, Leash& leash, Vec2 motion_mm) const;
    void slide(b2Body& body, Leash const& leash, Vec2 motion_mm) const;

    WallIndex walls_;
    std::vector<Leash> leashes_;  // index as in World::bodies
};

}  // namespace pogosim
