// Links that callbacks of the whole run (pogosim/world.h) and hosts (pogosim/host.h) make and cut between two steps,
// with what both have to check.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "world/world.hpp"

namespace pogosim {

/// A link that is asked for. Objects are indices into World::objects.
struct NewLink {
    LinkKind kind = LinkKind::spring;
    std::uint32_t a = 0;
    std::uint32_t b = kNone;                                    // kNone: the arena
    Vec2 end_a_mm{};                                            // in the frame of the object: x ahead, y to its right
    Vec2 end_b_mm{};                                            // the same; with kNone: a place in the arena
    std::optional<float> length_mm{};                           // at rest; absent: as far apart as its ends are now
    float stiffness_n_m = 0.0F;                                 // of a spring, at least 0
    float damping_n_s_m = 0.0F;                                 // of a spring, at least 0
    float breaking_n = std::numeric_limits<float>::infinity();  // above 0
    float least_rad = -std::numeric_limits<float>::infinity();  // of a hinge: at most 0
    float most_rad = std::numeric_limits<float>::infinity();    // of a hinge: at least 0
};

/// The category of links that were not made by the configuration.
inline constexpr char const* kMadeLinks = "made";

/// A link whose ends are the centres of its objects; those of a hinge are halfway between them, and in the arena at the
/// centre of `a`. Throws ConfigError if one of them cannot be linked.
NewLink link_between(World const& world, LinkKind kind, std::uint32_t a, std::uint32_t b);

/// Makes a link, which holds from the next step on. Returns its index into World::links. Throws ConfigError, and makes
/// none, for objects that cannot be linked (none of this number, without a body or a membrane; twice the same; both
/// fixed), for numbers out of range, and for a rod or hinge that its ends do not fit.
std::uint32_t add_link(World& world, NewLink const& link);

/// Cuts a link, for good. Does nothing if it is cut. Throws ConfigError if there is none of this index.
void cut_link(World& world, std::size_t link);

/// The link of this index. Throws ConfigError if there is none.
Link const& link_at(World const& world, std::size_t link);

/// Index into World::objects of what has this body; kNone for the arena.
std::uint32_t object_of_body(World const& world, std::uint32_t body);

/// The same for all bodies. Shape: one entry per body.
std::vector<std::uint32_t> objects_of_bodies(World const& world);

}  // namespace pogosim
