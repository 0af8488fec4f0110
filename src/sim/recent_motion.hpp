// How far robots have come in the last time: what tells one that drives from one that pushes. Pressed against a wall, a
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

    /// Call it after each step. What puts robots elsewhere between two steps does not count.
    void follow(World const& world);

    struct Displacement {
        float distance_mm = 0.0F;  // between the ends of its way
        double during_s = 0.0;     // the window, less when the run is younger
    };
    /// `window_s`: up to kWindowS.
    Displacement of(std::uint32_t robot, double window_s) const;

private:
    /// Where the sum of all steps has brought each robot, from where it was at the first one.
    struct Sample {
        double time_s = 0.0;
        std::vector<Vec2> way_mm;
    };

    std::vector<std::uint32_t> object_;  // of robots, in World::objects
    Sample now_;
    std::deque<Sample> samples_;  // oldest first; the first one is as old as the window, or older
};

}  // namespace pogosim
