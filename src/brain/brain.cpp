#include "brain/brain.hpp"

#include <algorithm>

namespace pogosim {

RobotRange robots_of(World const& world, std::uint32_t category) {
    auto const& of_robots = world.robots.category;
    auto const found = std::ranges::equal_range(of_robots, category);
    return {.first = static_cast<std::uint32_t>(found.begin() - of_robots.begin()),
            .last = static_cast<std::uint32_t>(found.end() - of_robots.begin())};
}

}  // namespace pogosim
