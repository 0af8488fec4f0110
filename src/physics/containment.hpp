// Keeps bodies on their side of the walls, whatever their speed.
//
// An engine pushes a body out of a wall only while the body's centre is on the free side: whoever jumps across, or is
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

#include <cmath>
#include <cstdint>
#include <vector>

#include "geometry/wall_index.hpp"
#include "world/world.hpp"

namespace pogosim {

class Containment {
public:
    /// Takes the bodies where they are in the world now: their centres are inside the arena.
    explicit Containment(World const& world);

    /// Where a body may be that the engine has moved to `place_mm` (finite) in one step: there, or where it is put
    /// back.
    /// Who is put back should keep its velocity: it touches the wall now, and the engine's next step throws it back.
    Vec2 hold(std::uint32_t body, Vec2 place_mm) {
        Leash& leash = leashes_[body];
        Vec2 const motion_mm = place_mm - leash.last_mm;
        float const moved_mm = std::abs(motion_mm.x) + std::abs(motion_mm.y);  // at most
        if (moved_mm >= leash.free_mm) {
            return look_at_walls(leash, place_mm, kSunkShare);
        }
        leash.free_mm -= moved_mm;
        leash.last_mm = place_mm;
        return place_mm;
    }

    /// The same for a body that goes so far in a step that the engine has not seen the wall: it sinks in nowhere.
    Vec2 hold_fast(std::uint32_t body, Vec2 place_mm) { return look_at_walls(leashes_[body], place_mm, 1.0F); }

    /// Where a body was held last.
    Vec2 last(std::uint32_t body) const { return leashes_[body].last_mm; }

    /// Takes a body where it is now, as the constructor does.
    void start_from(std::uint32_t body, Vec2 place_mm) {
        leashes_[body].last_mm = place_mm;
        leashes_[body].free_mm = 0.0F;
    }

    WallIndex const& walls() const { return walls_; }

private:
    // A body is put back when it has sunk into a wall by this share of its inner radius.
    static constexpr float kSunkShare = 0.5F;

    /// Of one body.
    struct Leash {
        Vec2 last_mm;            // where it was held last
        float free_mm = 0.0F;    // no wall is reached by moving less than this
        float radius_mm = 0.0F;  // of the largest disk around the centre in the shape
    };

    Vec2 look_at_walls(Leash& leash, Vec2 place_mm, float sunk_share) const;
    Vec2 slide(Leash const& leash, Vec2 motion_mm) const;

    WallIndex walls_;
    std::vector<Leash> leashes_;  // index as in World::bodies
};

}  // namespace pogosim
