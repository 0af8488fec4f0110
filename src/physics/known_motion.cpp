#include "physics/known_motion.hpp"

#include <cmath>
#include <cstring>

namespace pogosim {

namespace {

/// A bitwise comparison, as fast as memory. A false alarm, such as 0 against -0, does no harm.
template <class T>
bool has_same_bytes(std::vector<T> const& a, std::vector<T> const& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

}  // namespace

void KnownMotion::copy(Bodies const& bodies) {
    position_mm_ = bodies.position_mm;
    heading_rad_ = bodies.heading_rad;
    velocity_mm_s_ = bodies.velocity_mm_s;
    angular_velocity_rad_s_ = bodies.angular_velocity_rad_s;
}

void KnownMotion::end_step(Bodies& bodies) {
    // The poses known from before the step become the start of the step, by a swap instead of a copy.
    bodies.start_mm.swap(position_mm_);
    bodies.start_rad.swap(heading_rad_);
    copy(bodies);
    was_still_ = false;
}

void KnownMotion::end_still_step(Bodies& bodies) {
    if (!was_still_) {
        bodies.start_mm = position_mm_;
        bodies.start_rad = heading_rad_;
        was_still_ = true;
    }
}

bool KnownMotion::is_of(Bodies const& bodies) const {
    return has_same_bytes(position_mm_, bodies.position_mm) && has_same_bytes(heading_rad_, bodies.heading_rad) &&
           has_same_bytes(velocity_mm_s_, bodies.velocity_mm_s) &&
           has_same_bytes(angular_velocity_rad_s_, bodies.angular_velocity_rad_s);
}

std::vector<std::uint32_t> KnownMotion::find_moved(Bodies& bodies) const {
    std::vector<std::uint32_t> moved;
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        if (!is_finite(bodies, i)) {
            restore(bodies, i);
        } else if (has_other_pose(bodies, i)) {
            moved.push_back(i);
        }
    }
    return moved;
}

bool KnownMotion::has_other_pose(Bodies const& bodies, std::uint32_t body) const {
    return position_mm_[body] != bodies.position_mm[body] || heading_rad_[body] != bodies.heading_rad[body];
}

bool KnownMotion::has_other_velocity(Bodies const& bodies, std::uint32_t body) const {
    return velocity_mm_s_[body] != bodies.velocity_mm_s[body] ||
           angular_velocity_rad_s_[body] != bodies.angular_velocity_rad_s[body];
}

void KnownMotion::restore(Bodies& bodies, std::uint32_t body) const {
    bodies.position_mm[body] = position_mm_[body];
    bodies.heading_rad[body] = heading_rad_[body];
    bodies.heading_dir[body] = direction(heading_rad_[body]);
    bodies.velocity_mm_s[body] = velocity_mm_s_[body];
    bodies.angular_velocity_rad_s[body] = angular_velocity_rad_s_[body];
}

bool is_finite(Bodies const& bodies, std::uint32_t body) {
    Vec2 const position_mm = bodies.position_mm[body];
    Vec2 const velocity_mm_s = bodies.velocity_mm_s[body];
    return std::isfinite(position_mm.x) && std::isfinite(position_mm.y) && std::isfinite(bodies.heading_rad[body]) &&
           std::isfinite(velocity_mm_s.x) && std::isfinite(velocity_mm_s.y) &&
           std::isfinite(bodies.angular_velocity_rad_s[body]);
}

}  // namespace pogosim
