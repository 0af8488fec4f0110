// Where robots have been: the last positions of each, at least 2 mm apart.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "world/world.hpp"

namespace pogosim {

struct TrailPoint {
    Vec2 position_mm;
    Rgb led;  // of the head at the time
};

/// Shape: a ring buffer of kLength points per robot, fewer in a swarm that would need more than the memory allowed.
class Trails {
public:
    static constexpr std::size_t kLength = 512;
    static constexpr float kSpacingMm = 2.0F;

    explicit Trails(std::size_t most_bytes = SIZE_MAX) : most_bytes_(most_bytes) {}

    /// Takes the positions of the robots of a world, once a step. Robots without a body, and membranes, leave no trail.
    void follow(World const& world);

    /// Forgets all positions.
    void clear() { *this = Trails(most_bytes_); }

    /// Takes over trails as a recording has them: so many points of each robot, one robot after the other, oldest
    /// first. Each keeps its last kLength points. They fade over `fading` points, at least 1.
    void take(std::span<TrailPoint const> points, std::span<std::uint32_t const> counts, std::size_t fading);

    /// Over how many points a trail fades to nothing.
    std::size_t fading() const { return fading_; }

    std::size_t robot_count() const { return count_.size(); }
    /// Points of one robot, at most kLength.
    std::size_t size(std::size_t robot) const { return count_[robot]; }
    /// The point before `age` others, 0 being the newest.
    TrailPoint const& point(std::size_t robot, std::size_t age) const {
        return points_[robot * length_ + (next_[robot] + length_ - 1 - age) % length_];
    }

private:
    static constexpr std::size_t kLeastLength = 16;

    std::size_t most_bytes_;
    std::size_t length_ = kLength;  // of each buffer
    std::size_t fading_ = kLength;
    std::vector<TrailPoint> points_;
    std::vector<std::uint16_t> count_;  // by robot
    std::vector<std::uint16_t> next_;   // by robot: where the next point goes in its buffer
};

}  // namespace pogosim
