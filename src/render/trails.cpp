#include "render/trails.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pogosim {

namespace {

bool leaves_a_trail(World const& world, std::size_t robot) {
    return world.robots.body[robot] != kNone && !world.categories[world.robots.category[robot]].spec.membrane;
}

}  // namespace

void Trails::follow(World const& world) {
    std::size_t const robots = world.robots.size();
    if (robots != robot_count()) {
        length_ = std::clamp(most_bytes_ / (sizeof(TrailPoint) * robots), kLeastLength, kLength);
        points_.assign(robots * length_, {});
        count_.assign(robots, 0);
        next_.assign(robots, 0);
    }
    for (std::size_t i = 0; i < robots; ++i) {
        if (!leaves_a_trail(world, i)) {
            continue;
        }
        Vec2 const position = wrapped(world, world.bodies.position_mm[world.robots.body[i]]);
        float const moved =
            count_[i] == 0 ? kSpacingMm : length(minimum_image(world, point(i, 0).position_mm, position));
        if (!(moved >= kSpacingMm) || !std::isfinite(moved)) {
            continue;
        }
        points_[i * length_ + next_[i]] = {position, world.robots.led[i][0]};
        next_[i] = static_cast<std::uint16_t>((next_[i] + 1U) % length_);
        count_[i] = static_cast<std::uint16_t>(std::min<std::size_t>(count_[i] + 1U, length_));
    }
}

void Trails::take(std::span<TrailPoint const> points, std::span<std::uint32_t const> counts, std::size_t fading) {
    length_ = kLength;
    fading_ = std::max<std::size_t>(fading, 1);
    points_.resize(counts.size() * length_);
    count_.assign(counts.size(), 0);
    next_.assign(counts.size(), 0);
    for (std::size_t i = 0; i < counts.size(); ++i) {
        std::span<TrailPoint const> const own = points.first(counts[i]).last(std::min<std::size_t>(counts[i], length_));
        std::ranges::copy(own, points_.begin() + static_cast<std::ptrdiff_t>(i * length_));
        count_[i] = static_cast<std::uint16_t>(own.size());
        next_[i] = static_cast<std::uint16_t>(own.size() % length_);
        points = points.subspan(counts[i]);
    }
}

}  // namespace pogosim
