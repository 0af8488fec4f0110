#include "physics/islands.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pogosim {

Islands::Islands(World const& world) : alone_(world.bodies.size()) {
    std::iota(alone_.begin(), alone_.end(), 0U);
}

/// Of a forest whose ways are made shorter as they are walked: R. E. Tarjan, "Efficiency of a good but not linear set
/// union algorithm", Journal of the ACM 22 (1975) 215.
std::uint32_t Islands::root_of(std::uint32_t body) {
    while (parent_[body] != body) {
        body = parent_[body] = parent_[parent_[body]];
    }
    return body;
}

void Islands::find_pairs(World const& world, DiskContacts const& contacts, float reach_mm, float tolerance_mm) {
    std::vector<Vec2> const& position_mm = world.bodies.position_mm;
    std::vector<Vec2> const& velocity_mm_s = world.bodies.velocity_mm_s;
    auto const dt_s = static_cast<float>(world.time_step_s);
    for (std::uint32_t i = 0; i < contacts.pair_count(); ++i) {
        auto const& [a, b, law] = contacts.near()[i];
        Vec2 const way = minimum_image(world, position_mm[b], position_mm[a]);
        float const far_mm = law.radius_mm + reach_mm;
        float const distance_mm2 = squared_length(way);
        if (distance_mm2 >= far_mm * far_mm) {
            continue;
        }
        // gap + tolerance < time * closing speed, times the distance
        float const separation_mm2 = dt_s * dot(velocity_mm_s[a] - velocity_mm_s[b], way);
        float const free_mm = law.radius_mm - tolerance_mm;
        meets_.push_back(distance_mm2 + std::min(separation_mm2, 0.0F) < free_mm * std::sqrt(distance_mm2) ? 1 : 0);
        links_.push_back({.contact = i, .next = kNone});
        std::uint32_t const root_a = root_of(a);
        std::uint32_t const root_b = root_of(b);
        parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
    }
}

void Islands::find_fixed(World const& world, DiskContacts const& contacts, float reach_mm, float tolerance_mm) {
    auto const dt_s = static_cast<float>(world.time_step_s);
    for (std::uint32_t i = contacts.pair_count(); i < contacts.near().size(); ++i) {
        NearContact const& near = contacts.near()[i];
        std::optional<Gap> const gap = contacts.gap_to_fixed(world, i, world.bodies.position_mm[near.a]);
        if (!gap || gap->distance_mm >= near.law.radius_mm + reach_mm) {
            continue;
        }
        float const separation_mm = dt_s * dot(world.bodies.velocity_mm_s[near.a], gap->normal);
        float const gap_mm = gap->distance_mm - near.law.radius_mm;
        meets_.push_back(gap_mm + tolerance_mm + std::min(separation_mm, 0.0F) < 0.0F ? 1 : 0);
        links_.push_back({.contact = i, .next = kNone});
    }
}

/// Appends each contact to the list of its island.
void Islands::link(DiskContacts const& contacts) {
    islands_.clear();
    for (std::uint32_t i = 0; i < links_.size(); ++i) {
        std::uint32_t const body = contacts.near()[links_[i].contact].a;
        std::uint32_t const root = root_of(body);
        parent_[body] = root;
        if (island_[root] == kNone) {
            island_[root] = static_cast<std::uint32_t>(islands_.size());
            islands_.push_back({.first = i});
        } else {
            links_[islands_[island_[root]].last].next = i;
        }
        Island& island = islands_[island_[root]];
        island.last = i;
        ++island.contact_count;
        island.is_active = island.is_active || meets_[i] != 0;
    }
}

void Islands::mark_bodies(DiskContacts const& contacts) {
    for (std::uint32_t i = 0; i < links_.size(); ++i) {
        NearContact const& near = contacts.near()[links_[i].contact];
        if (islands_[island_[parent_[near.a]]].is_active) {
            has_contact_[near.a] = 1;
            if (links_[i].contact < contacts.pair_count()) {
                has_contact_[near.b] = 1;
            }
        }
    }
}

void Islands::find(World const& world, DiskContacts const& contacts, float reach_mm, float tolerance_mm) {
    parent_ = alone_;
    island_.assign(alone_.size(), kNone);
    has_contact_.assign(alone_.size(), 0);
    links_.clear();
    meets_.clear();
    find_pairs(world, contacts, reach_mm, tolerance_mm);
    find_fixed(world, contacts, reach_mm, tolerance_mm);
    link(contacts);
    mark_bodies(contacts);
}

}  // namespace pogosim
