// How far robots have come lately, which tells a robot that drives from one that pushes. Pressed against a wall, a
// robot bounces by a millimetre (wall_restitution) at each of its ticks, so a single step does not tell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "world/world.hpp"

namespace pogosim {

class RecentMotion {
public:
    static constexpr double kWindowS = 1.0;

    explicit RecentMotion(World const& world);

    /// Call it after each step. Moves of robots by hand or by a host between two steps do not count.
    void follow(World const& world);

    struct Displacement {
        float distance_mm = 0.0F;  // in a straight line, from the start of the window to now
        double during_s = 0.0;     // length of the window; shorter if the run is younger
    };
    /// `window_s`: up to kWindowS.
    Displacement of(std::uint32_t robot, double window_s) const;

private:
    /// Sum of all displacements of each robot since the first step.
    struct Sample {
        double time_s = 0.0;
        std::vector<Vec2> way_mm;
    };

    std::vector<std::uint32_t> object_;  // of robots, in World::objects
    Sample now_;
    std::deque<Sample> samples_;  // oldest first; the first one is as old as the window, or older
};

}  // namespace pogosim
