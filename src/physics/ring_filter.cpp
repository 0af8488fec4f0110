#include "physics/ring_filter.hpp"

#include <algorithm>
#include <limits>

namespace pogosim {

namespace {

/// Along a straight line, bodies further on than this do not touch when the ring is at rest.
std::uint32_t touching_neighbours(Bodies const& bodies, Ring const& ring) {
    float shortest_step_mm = std::numeric_limits<float>::infinity();
    float largest_mm = 0.0F;
    for (std::uint32_t k = 0; k < ring.body_count; ++k) {
        std::uint32_t const body = ring.body + k;
        std::uint32_t const next = ring.body + (k + 1) % ring.body_count;
        shortest_step_mm = std::min(shortest_step_mm, length(bodies.position_mm[next] - bodies.position_mm[body]));
        largest_mm = std::max(largest_mm, 2.0F * bodies.radius_mm[body]);
    }
    return static_cast<std::uint32_t>(std::min(largest_mm / shortest_step_mm, static_cast<float>(ring.body_count))) + 1;
}

}  // namespace

RingFilter::RingFilter(World const& world) : places_(world.rings.empty() ? 0 : world.bodies.size()) {
    for (std::uint32_t r = 0; r < world.rings.size(); ++r) {
        Ring const& ring = world.rings[r];
        std::uint32_t const neighbours = touching_neighbours(world.bodies, ring);
        for (std::uint32_t k = 0; k < ring.body_count; ++k) {
            std::uint32_t const body = ring.body + k;
            places_[body] = {.ring = r,
                             .number = k,
                             .count = ring.body_count,
                             .neighbours = neighbours,
                             .at_rest_mm = world.bodies.position_mm[body],
                             .radius_mm = world.bodies.radius_mm[body]};
        }
    }
}

bool RingFilter::ShouldCollide(b2Fixture* a, b2Fixture* b) {
    std::uintptr_t const body_a = a->GetUserData().pointer;
    std::uintptr_t const body_b = b->GetUserData().pointer;
    if (body_a >= places_.size() || body_b >= places_.size()) {
        return true;  // a wall, or there are no rings
    }
    PlaceInRing const& one = places_[body_a];
    PlaceInRing const& other = places_[body_b];
    if (one.ring == kNone || one.ring != other.ring) {
        return true;
    }
    std::uint32_t const steps = one.number > other.number ? one.number - other.number : other.number - one.number;
    bool const are_neighbours = std::min(steps, one.count - steps) <= one.neighbours;
    return !are_neighbours && length(other.at_rest_mm - one.at_rest_mm) >= one.radius_mm + other.radius_mm;
}

}  // namespace pogosim
