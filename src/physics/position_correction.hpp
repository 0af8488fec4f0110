// Position correction: keeps bodies on their side of the walls at any speed.
//
// An engine pushes a body out of a wall only while the body's centre is on the free side: a body that jumps across, or
// is pushed across by a crowd, would be lost. So the path of each centre is tested after the engine's step. The path is
// half as wide as the body: a body that has sunk into a wall by more than half its inner radius is put back to where it
// touched the wall, and the rest of its motion runs along the wall.
//
//        wall
//         |      .--.
//     <---|-----(  o )     the engine's motion
//         |.--.  '--'
//         (  o )           the corrected motion
//         |'--'
//
// Most steps need no test: for each body, the distance is known within which it cannot reach a wall.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "geometry/wall_index.hpp"
#include "world/world.hpp"

namespace pogosim {

class PositionCorrection {
public:
    /// Starts from the present positions of the bodies, whose centres are inside the arena.
    explicit PositionCorrection(World const& world);

    /// The corrected place of a body that the engine has moved to `place_mm` (finite) in one step. A body that is put
    /// back should keep its velocity: it now touches the wall, and bounces in the engine's next step.
    Vec2 hold(std::uint32_t body, Vec2 place_mm) {
        Clearance& clearance = clearances_[body];
        Vec2 const motion_mm = place_mm - clearance.last_mm;
        float const moved_mm = std::abs(motion_mm.x) + std::abs(motion_mm.y);  // at most
        if (moved_mm >= clearance.free_mm) {
            return look_at_walls(clearance, place_mm, kSunkShare);
        }
        clearance.free_mm -= moved_mm;
        clearance.last_mm = place_mm;
        return place_mm;
    }

    /// The same for a body that moves so far in a step that the engine has missed the wall: it may not sink in at all.
    Vec2 hold_fast(std::uint32_t body, Vec2 place_mm) { return look_at_walls(clearances_[body], place_mm, 1.0F); }

    /// No wall is nearer to the last corrected place of a body.
    float free_mm(std::uint32_t body) const { return clearances_[body].free_mm; }

    /// The last corrected place of a body.
    Vec2 last(std::uint32_t body) const { return clearances_[body].last_mm; }

    /// Starts anew from the place of a body, as the constructor does.
    void start_from(std::uint32_t body, Vec2 place_mm) {
        clearances_[body].last_mm = place_mm;
        clearances_[body].free_mm = 0.0F;
    }

    WallIndex const& walls() const { return walls_; }

    /// What later steps depend on, see state_bytes.hpp.
    template <class Self, class State>
    static void visit_state(Self& self, State& state) {
        state(self.clearances_);
    }

private:
    // A body is put back when it has sunk into a wall by this share of its inner radius.
    static constexpr float kSunkShare = 0.5F;

    /// How far one body can move without a test.
    struct Clearance {
        Vec2 last_mm;            // last corrected place
        float free_mm = 0.0F;    // no wall is reached by moving less than this
        float radius_mm = 0.0F;  // of the largest disk around the centre in the shape
    };

    Vec2 look_at_walls(Clearance& clearance, Vec2 place_mm, float sunk_share) const;
    Vec2 slide(Clearance const& clearance, Vec2 motion_mm) const;

    WallIndex walls_;
    std::vector<Clearance> clearances_;  // index as in World::bodies
};

}  // namespace pogosim
