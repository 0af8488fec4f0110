#include "sim/link_finder.hpp"

#include <algorithm>

#include "render/infrared_ends.hpp"

namespace pogosim {

namespace {

bool has_outline(World const& world, std::uint32_t robot) {
    return world.spec_of(robot).model.sends_along_outline;
}

Vec2 centre_of(World const& world, std::uint32_t robot) {
    return world.bodies.position_mm[world.robots.body[robot]];
}

float radius_of(World const& world, std::uint32_t robot) {
    return world.bodies.radius_mm[world.robots.body[robot]];
}

LinkedBody body_of(World const& world, std::uint32_t robot) {
    std::uint32_t const body = world.robots.body[robot];
    return {.shape = world.bodies.shape[body],
            .radius_mm = world.bodies.radius_mm[body],
            .heading_rad = world.bodies.heading_rad[body]};
}

/// The ends of a link, on the outlines of both robots.
void place_between_robots(World const& world, InfraredLink& link) {
    Vec2 const centre_mm = wrapped(world, centre_of(world, link.from));
    Vec2 const span_mm = minimum_image(world, centre_of(world, link.from), centre_of(world, link.to));
    place_ends(link, centre_mm, body_of(world, link.from), span_mm, body_of(world, link.to));
}

}  // namespace

std::uint8_t LinkFinder::emitters_between(std::uint32_t from, std::uint32_t to) const {
    auto const first = reached_.begin() + start_[from];
    auto const last = reached_.begin() + start_[from + 1];
    auto const found =
        std::lower_bound(first, last, to, [](Reach const& reach, std::uint32_t robot) { return reach.to < robot; });
    return found != last && found->to == to ? found->emitters : std::uint8_t{0};
}

void LinkFinder::place(World const& world, float range_mm, InfraredLink& link) {
    bool const is_from_outline = has_outline(world, link.from);
    if (!is_from_outline && !has_outline(world, link.to)) {
        place_between_robots(world, link);
        return;
    }
    // The link between the rim of one robot and the nearest point of the other's outline.
    std::uint32_t const robot = is_from_outline ? link.to : link.from;
    std::uint32_t const outline = is_from_outline ? link.from : link.to;
    Vec2 const to_outline =
        visibility_.to_outline(world, robot, outline, face_reach_mm(world, robot) + range_mm).value_or(Vec2{});
    float const share = std::min(radius_of(world, robot) / std::max(length(to_outline), 1e-6F), 1.0F);
    Vec2 const on_rim = share * to_outline;
    Vec2 const centre = centre_of(world, robot);
    Vec2 const from_mm = centre + (is_from_outline ? to_outline : on_rim);
    link.from_mm = wrapped(world, from_mm);
    link.to_mm = link.from_mm + (is_from_outline ? on_rim - to_outline : to_outline - on_rim);
}

std::vector<InfraredLink> LinkFinder::find(World const& world, std::span<float const> range_mm) {
    auto const count = static_cast<std::uint32_t>(world.robots.size());
    visibility_.update(world);
    reached_.clear();
    start_.clear();
    for (std::uint32_t robot = 0; robot < count; ++robot) {
        start_.push_back(static_cast<std::uint32_t>(reached_.size()));
        for (Receiver const& receiver : visibility_.receivers(world, robot, kAllFaces, range_mm[robot])) {
            reached_.push_back({.to = receiver.robot, .emitters = receiver.emitters});
        }
    }
    start_.push_back(static_cast<std::uint32_t>(reached_.size()));

    std::vector<InfraredLink> links;
    for (std::uint32_t from = 0; from < count; ++from) {
        for (std::uint32_t k = start_[from]; k < start_[from + 1]; ++k) {
            auto const [to, emitters] = reached_[k];
            std::uint8_t const emitters_back = emitters_between(to, from);
            if (from < to || emitters_back == 0) {
                links.push_back({.from = from,
                                 .to = to,
                                 .from_mm = {},
                                 .to_mm = {},
                                 .emitters = emitters,
                                 .emitters_back = emitters_back});
                place(world, range_mm[from], links.back());
            }
        }
    }
    return links;
}

}  // namespace pogosim
