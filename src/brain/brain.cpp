#include "brain/brain.hpp"

#include <algorithm>

namespace pogosim {

namespace {

struct SavedBytes final : SavedBrain {
    std::size_t byte_count() const override { return bytes.size(); }
    std::vector<std::byte> bytes;
};

}  // namespace

std::unique_ptr<SavedBrain> Brain::save() {
    auto saved = std::make_unique<SavedBytes>();
    append_state(saved->bytes);
    return saved;
}

void Brain::restore(SavedBrain const& saved) {
    std::span<std::byte const> bytes = static_cast<SavedBytes const&>(saved).bytes;
    take_state(bytes);
}

void Brain::append_for_process(StateWriter& state) {
    std::vector<std::byte> bytes;
    append_state(bytes);
    state(bytes);
}

void Brain::take_from_process(StateReader& state) {
    std::vector<std::byte> bytes;
    state(bytes);
    std::span<std::byte const> rest = bytes;
    take_state(rest);
}

RobotRange robots_of(World const& world, std::uint32_t category) {
    auto const& of_robots = world.robots.category;
    auto const first = std::ranges::lower_bound(of_robots, category);
    auto const last = std::ranges::upper_bound(of_robots, category);
    return {.first = static_cast<std::uint32_t>(first - of_robots.begin()),
            .last = static_cast<std::uint32_t>(last - of_robots.begin())};
}

}  // namespace pogosim
