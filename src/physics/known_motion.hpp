// Poses and velocities of the bodies as an engine last read or wrote them, to detect changes made from outside.
#pragma once

#include <cstdint>
#include <vector>

#include "world/world.hpp"

namespace pogosim {

class KnownMotion {
public:
    void copy(Bodies const& bodies);

    /// Ends a step: what was known until now is where it began.
    void end_step(Bodies& bodies);

    /// The same for a step in which nothing has moved.
    void end_still_step(Bodies& bodies);

    /// True if nothing has been written since copy().
    bool is_of(Bodies const& bodies) const;

    /// Reverts values that are not finite. Returns the bodies whose pose has changed since copy(), ascending.
    std::vector<std::uint32_t> find_moved(Bodies& bodies) const;

    Vec2 position_mm(std::uint32_t body) const { return position_mm_[body]; }
    float heading_rad(std::uint32_t body) const { return heading_rad_[body]; }

    bool has_other_velocity(Bodies const& bodies, std::uint32_t body) const;

private:
    bool has_other_pose(Bodies const& bodies, std::uint32_t body) const;
    void restore(Bodies& bodies, std::uint32_t body) const;

    std::vector<Vec2> position_mm_;
    std::vector<float> heading_rad_;
    std::vector<Vec2> velocity_mm_s_;
    std::vector<float> angular_velocity_rad_s_;
    bool was_still_ = false;  // the last step
};

bool is_finite(Bodies const& bodies, std::uint32_t body);

}  // namespace pogosim
