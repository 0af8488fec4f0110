#include "physics/assemblies.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "physics/disjoint_sets.hpp"

namespace pogosim {

namespace {

std::uint64_t pair_of(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32U | std::max(a, b);
}

bool is_hinge(Joint const& joint) {
    return joint.length_mm == 0.0F;
}

}  // namespace

Assemblies::Assemblies(World const& world) : joint_count_(world.joints.size()), link_changes_(world.link_changes) {
    find(world);
}

bool Assemblies::follow(World const& world) {
    if (link_changes_ == world.link_changes) {
        return false;
    }
    link_changes_ = world.link_changes;
    find(world);
    return true;
}

bool Assemblies::may_collide(std::uint32_t a, std::uint32_t b) const {
    return hinged_.empty() || !std::ranges::binary_search(hinged_, pair_of(a, b));
}

Assembly& Assemblies::of(std::uint32_t body) {
    std::uint32_t& place = place_[first_body_[body]];
    if (place == kNone) {
        place = static_cast<std::uint32_t>(assemblies_.size());
        assemblies_.emplace_back();
    }
    return assemblies_[place];
}

void Assemblies::find(World const& world) {
    auto const count = static_cast<std::uint32_t>(world.bodies.size());
    auto const is_movable = [&](std::uint32_t body) { return body != kNone && !world.bodies.spec[body].fixed; };
    impulses_.resize(joint_count_ + world.links.size());
    first_body_.resize(count);
    std::iota(first_body_.begin(), first_body_.end(), 0U);
    std::vector<std::uint8_t> is_held(count, 0);
    for (Membrane const& membrane : world.membranes) {
        for (std::uint32_t i = membrane.body; i < membrane.body + membrane.body_count; ++i) {
            unite(first_body_, membrane.body, i);
            is_held[i] = 1;
        }
    }
    hinged_.clear();
    for (Link const& link : world.links) {
        if (link.is_cut) {
            continue;
        }
        for (std::uint32_t const body : {link.a, link.b}) {
            if (is_movable(body)) {
                is_held[body] = 1;
            }
        }
        if (is_movable(link.a) && is_movable(link.b)) {
            unite(first_body_, link.a, link.b);
        }
        if (link.kind == LinkKind::hinge && link.b != kNone) {
            hinged_.push_back(pair_of(link.a, link.b));
        }
    }
    std::ranges::sort(hinged_);

    assemblies_.clear();
    place_.assign(count, kNone);
    flatten(first_body_);
    for (std::uint32_t i = 0; i < count; ++i) {
        if (is_held[i] != 0) {
            of(i).bodies.push_back(i);
        }
    }
    for (std::uint32_t i = 0; i < world.membranes.size(); ++i) {
        of(world.membranes[i].body).membranes.push_back(i);
    }
    for (std::uint32_t i = 0; i < world.joints.size(); ++i) {
        if (is_hinge(world.joints[i])) {
            of(world.joints[i].a).hinges.push_back(i);
        }
    }
    for (std::uint32_t i = 0; i < world.links.size(); ++i) {
        Link const& link = world.links[i];
        if (!link.is_cut && (is_movable(link.a) || is_movable(link.b))) {
            of(is_movable(link.a) ? link.a : link.b).links.push_back(i);
        }
    }
}

void break_links(World& world) {
    for (Link& link : world.links) {
        if (!link.is_cut && std::abs(link.tension_n) > link.breaking_n) {
            link.is_cut = true;
            ++world.link_changes;
        }
        if (link.is_cut) {
            link.tension_n = 0.0F;
        }
    }
}

}  // namespace pogosim
