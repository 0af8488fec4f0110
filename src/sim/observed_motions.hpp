// Velocities of all bodies observed in the last step, as arrays that hosts read in place.
#pragma once

#include <vector>

#include "world/observed_motion.hpp"
#include "world/world.hpp"

namespace pogosim {

/// Shape: one entry per body, see observed_motion().
class ObservedMotions {
public:
    explicit ObservedMotions(World const& world)
        : velocity_mm_s_(world.bodies.size()), angular_velocity_rad_s_(world.bodies.size()) {
        update(world);
    }

    /// To be called after a step.
    void update(World const& world) { update(world, 0, static_cast<std::uint32_t>(world.bodies.size())); }

    /// To be called after an object has been put elsewhere.
    void update(World const& world, Object const& object) {
        update(world, object.body, object.body + object.body_count);
    }

    std::vector<Vec2> const& velocity_mm_s() const { return velocity_mm_s_; }
    std::vector<float> const& angular_velocity_rad_s() const { return angular_velocity_rad_s_; }

private:
    void update(World const& world, std::uint32_t first, std::uint32_t last) {
        for (std::uint32_t i = first; i < last; ++i) {
            ObservedMotion const motion = observed_motion(world, i);
            velocity_mm_s_[i] = motion.velocity_mm_s;
            angular_velocity_rad_s_[i] = motion.angular_velocity_rad_s;
        }
    }

    std::vector<Vec2> velocity_mm_s_;
    std::vector<float> angular_velocity_rad_s_;
};

}  // namespace pogosim
