#include "physics/islands.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/four.hpp"
#include "physics/disjoint_sets.hpp"
#include "physics/mover.hpp"

namespace pogosim {

namespace {

constexpr std::uint32_t kLeastRange = 2048;  // contacts
constexpr std::uint32_t kPairsAhead = 32;    // bodies of a contact are prefetched so many contacts ahead

void prefetch_motion(World const& world, std::uint32_t body) {
    __builtin_prefetch(&world.bodies.position_mm[body]);
    __builtin_prefetch(&world.bodies.velocity_mm_s[body]);
}

/// Disks of membranes may turn without moving anything; a turn of what a link or hinge holds moves the others. So does
/// a link that pulls.
bool is_moving(World const& world, Assembly const& assembly) {
    Bodies const& bodies = world.bodies;
    bool const can_turn = !assembly.hinges.empty() || !assembly.links.empty();
    return std::ranges::any_of(assembly.bodies,
                               [&](std::uint32_t body) {
                                   return bodies.velocity_mm_s[body] != Vec2{} ||
                                          (can_turn && bodies.angular_velocity_rad_s[body] != 0.0F);
                               }) ||
           std::ranges::any_of(assembly.links, [&](std::uint32_t link) { return world.links[link].tension_n != 0.0F; });
}

}  // namespace

/// Branch-free, since whether bodies are close is hard to predict.
void Islands::find_pairs(World const& world, NearContacts const& contacts, Reach const& reach, WorkRange pairs,
                         std::vector<Close>& found) {
    auto const dt_s = static_cast<float>(world.time_step_s);
    found.resize(pairs.last - pairs.first);
    std::size_t count = 0;
    bool const is_large = fills_caches(world);
    for (std::uint32_t first = pairs.first; first < pairs.last; first += kLanes) {
        for (std::uint32_t i = first + kPairsAhead; is_large && i < std::min(first + kPairsAhead + kLanes, pairs.last);
             ++i) {
            prefetch_motion(world, contacts.near()[i].a);
            prefetch_motion(world, contacts.near()[i].b);
        }
        std::array<Four, kLanes> motion;
        Four radius_mm = {};
        for (std::uint32_t i = 0; i < kLanes; ++i) {
            auto const& [a, b, law] = contacts.near()[std::min(first + i, pairs.last - 1)];
            Vec2 const way_mm = minimum_image(world, world.bodies.position_mm[b], world.bodies.position_mm[a]);
            Vec2 const velocity_mm_s = world.bodies.velocity_mm_s[a] - world.bodies.velocity_mm_s[b];
            motion[i] = Four{way_mm.x, way_mm.y, velocity_mm_s.x, velocity_mm_s.y};
            radius_mm[i] = law.radius_mm;
        }
        auto const [x_mm, y_mm, velocity_x_mm_s, velocity_y_mm_s] =
            transposed({motion[0], motion[1], motion[2], motion[3]});
        Four const far_mm = radius_mm + reach.reach_mm;
        Four const distance_mm2 = x_mm * x_mm + y_mm * y_mm;
        // gap + tolerance < time * closing speed, times the distance
        Four const separation_mm2 = dt_s * (velocity_x_mm_s * x_mm + velocity_y_mm_s * y_mm);
        Four const free_mm = radius_mm - kContactToleranceMm;
        FourInts const is_close = distance_mm2 < far_mm * far_mm;
        FourInts const meets = distance_mm2 + smaller(separation_mm2, Four{}) < free_mm * square_root(distance_mm2);
        for (std::uint32_t i = 0; i < std::min(kLanes, pairs.last - first); ++i) {
            found[count] = {.contact = first + i, .meets = meets[i] != 0};
            count += is_close[i] != 0 ? 1 : 0;
        }
    }
    found.resize(count);
}

void Islands::find_fixed(World const& world, NearContacts const& contacts, Reach const& reach, WorkRange fixed,
                         std::vector<Close>& found) {
    auto const dt_s = static_cast<float>(world.time_step_s);
    for (std::uint32_t i = fixed.first; i < fixed.last; ++i) {
        NearContact const& near = contacts.near()[i];
        std::optional<Gap> const gap = contacts.gap_to_fixed(world, i, world.bodies.position_mm[near.a]);
        if (!gap || gap->distance_mm >= near.law.radius_mm + reach.reach_mm) {
            continue;
        }
        float const separation_mm = dt_s * dot(world.bodies.velocity_mm_s[near.a], gap->normal);
        float const gap_mm = gap->distance_mm - near.law.radius_mm;
        bool const meets = gap_mm + kContactToleranceMm + std::min(separation_mm, 0.0F) < 0.0F;
        found.push_back({.contact = i, .meets = meets});
    }
}

void Islands::find_hulls(World const& world, NearContacts const& contacts, Reach const& reach, WorkRange hulls,
                         std::vector<Close>& found) {
    auto const dt_s = static_cast<float>(world.time_step_s);
    Bodies const& bodies = world.bodies;
    // At most the speed of a point of a body.
    auto const speed_mm_s = [&](std::uint32_t body) {
        return length(bodies.velocity_mm_s[body]) +
               std::abs(bodies.angular_velocity_rad_s[body]) * bodies.radius_mm[body];
    };
    for (std::uint32_t i = hulls.first; i < hulls.last; ++i) {
        auto const [a, b, law] = contacts.near()[i];
        float const closing_mm = dt_s * (speed_mm_s(a) + (contacts.is_pair(i) ? speed_mm_s(b) : 0.0F));
        float const beyond_mm = std::max(reach.reach_mm, closing_mm);
        float const gap_mm = contacts.gap_of_hull_mm(world, i, beyond_mm);
        if (gap_mm < beyond_mm) {
            found.push_back({.contact = i, .meets = gap_mm + kContactToleranceMm < closing_mm});
        }
    }
}

/// Lists the close contacts, and joins the trees of their bodies.
void Islands::unite(NearContacts const& contacts) {
    for (std::vector<Close> const& found : close_) {
        for (Close const& close : found) {
            contacts_.push_back({.contact = close.contact, .next = kNone});
            meets_.push_back(close.meets ? 1 : 0);
            if (contacts.is_pair(close.contact)) {
                pogosim::unite(parent_, contacts.near()[close.contact].a, contacts.near()[close.contact].b);
            }
        }
    }
}

/// Appends each contact to the list of its island. Branch-free, since which contact begins a new island is hard to
/// predict.
void Islands::link(NearContacts const& contacts) {
    islands_.reserve(contacts_.capacity() + 1);  // so that it grows as rarely
    islands_.assign(contacts_.size() + 1, {});
    std::uint32_t count = 1;
    for (std::uint32_t i = 0; i < contacts_.size(); ++i) {
        std::uint32_t& number = island_[parent_[contacts.near()[contacts_[i].contact].a]];
        bool const is_new = number == kNoIsland;
        number = is_new ? count : number;
        count += is_new ? 1 : 0;
        Island& island = islands_[number];
        island.first = std::min(island.first, i);
        contacts_[is_new ? i : island.last].next = i;
        contacts_[i].next = kNone;
        island.last = i;
        ++island.contact_count;
        island.is_active |= meets_[i] != 0;
    }
    islands_.resize(count);
}

/// Appends each assembly to the list of its island. A moving assembly keeps its island active; without contacts, it is
/// an island of its own.
void Islands::link_assemblies(World const& world, Assemblies const& assemblies, Reach const& reach) {
    next_assembly_.assign(assemblies.all().size(), kNone);
    for (std::uint32_t i = 0; i < next_assembly_.size(); ++i) {
        Assembly const& assembly = assemblies.all()[i];
        bool const moves = reach.wakes_assemblies || is_moving(world, assembly);
        std::uint32_t& island = island_[parent_[assembly.bodies.front()]];
        if (island == kNoIsland && moves) {
            island = static_cast<std::uint32_t>(islands_.size());
            islands_.emplace_back();
        }
        if (island != kNoIsland) {
            next_assembly_[i] = islands_[island].first_assembly;
            islands_[island].first_assembly = i;
            islands_[island].is_active = islands_[island].is_active || moves;
        }
    }
}

void Islands::find(World const& world, Assemblies const& assemblies, NearContacts const& contacts, Reach const& reach,
                   WorkerPool& workers) {
    parent_ = assemblies.first_bodies();
    island_.assign(parent_.size(), kNoIsland);
    contacts_.clear();
    meets_.clear();
    auto const count = static_cast<std::uint32_t>(contacts.near().size());
    close_.resize(workers.range_count(count, kLeastRange));
    workers.run_ranges(count, kLeastRange, [&](WorkRange range) {
        std::vector<Close>& found = close_[range.part];
        found.clear();
        WorkRange pairs = range;
        WorkRange fixed = range;
        WorkRange hulls = range;
        pairs.last = fixed.first = std::clamp(contacts.pair_count(), range.first, range.last);
        fixed.last = hulls.first = std::clamp(contacts.first_hull(), range.first, range.last);
        find_pairs(world, contacts, reach, pairs, found);
        find_fixed(world, contacts, reach, fixed, found);
        find_hulls(world, contacts, reach, hulls, found);
    });
    unite(contacts);
    flatten(parent_);
    link(contacts);
    link_assemblies(world, assemblies, reach);
    is_active_.reserve(islands_.capacity());  // so that it grows as rarely
    is_active_.resize(islands_.size());
    std::ranges::transform(islands_, is_active_.begin(), [](Island const& island) { return island.is_active ? 1 : 0; });
}

}  // namespace pogosim
