// Keeps everything on its side of soft membranes, whatever hits them.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/polygon.hpp"
#include "physics/box2d_units.hpp"
#include "world/world.hpp"

namespace pogosim {

/// The engine's contacts and joints give way under blows and crowds that are too strong for its few iterations, and a
/// body whose centre is past the middle of a membrane is pushed on to the wrong side. So the sides are compared after
/// each step: a body that has changed sides goes back to where it was before the step, at rest. When somebody is on the
/// wrong side of a membrane even so, because the membrane moved over him, the step does not take place for anybody.
/// Bodies that fit through the gaps between those of a membrane may pass.
class MembraneSides {
public:
    /// Takes sides and poses as they are now. `bodies`: all of the world.
    MembraneSides(World const& world, std::vector<b2Body*> const& bodies);

    /// To be called after a step of the engine. Returns whether bodies were put back.
    bool hold(std::vector<b2Body*> const& bodies);

    /// Takes sides and poses anew: in a periodic world, after objects went over the seam.
    void look_again(std::vector<b2Body*> const& bodies);

private:
    struct Pose {
        b2Vec2 position;
        float angle_rad = 0.0F;
    };
    /// A membrane and the bodies that cannot pass it.
    struct Side {
        Membrane membrane;
        std::vector<std::uint32_t> others;     // indices into World::bodies
        std::vector<std::uint8_t> was_inside;  // each of them, before the step
        std::vector<std::uint8_t> is_inside;   // and now
    };

    bool somebody_crossed(std::vector<b2Body*> const& bodies);
    void find_sides(std::vector<b2Body*> const& bodies, Side& side);
    void put_back(std::vector<b2Body*> const& bodies, std::size_t i) const;
    void remember_poses(std::vector<b2Body*> const& bodies);

    std::vector<Side> sides_;
    std::vector<Pose> poses_;  // of all bodies, before the step
    Polygon line_;             // scratch: the middle of a membrane
};

}  // namespace pogosim
