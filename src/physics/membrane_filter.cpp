#include "physics/membrane_filter.hpp"

#include <algorithm>
#include <limits>

namespace pogosim {

namespace {

/// On a straight piece of a membrane at rest, bodies that are more places apart than this do not touch.
std::uint32_t touching_neighbours(Bodies const& bodies, Membrane const& membrane) {
    float shortest_step_mm = std::numeric_limits<float>::infinity();
    float largest_mm = 0.0F;
    for (std::uint32_t k = 0; k < membrane.body_count; ++k) {
        std::uint32_t const body = membrane.body + k;
        std::uint32_t const next = membrane.body + (k + 1) % membrane.body_count;
        shortest_step_mm = std::min(shortest_step_mm, length(bodies.position_mm[next] - bodies.position_mm[body]));
        largest_mm = std::max(largest_mm, 2.0F * bodies.radius_mm[body]);
    }
    return static_cast<std::uint32_t>(
               std::min(largest_mm / shortest_step_mm, static_cast<float>(membrane.body_count))) +
           1;
}

}  // namespace

MembraneFilter::MembraneFilter(World const& world) : places_(world.membranes.empty() ? 0 : world.bodies.size()) {
    for (std::uint32_t r = 0; r < world.membranes.size(); ++r) {
        Membrane const& membrane = world.membranes[r];
        std::uint32_t const neighbours = touching_neighbours(world.bodies, membrane);
        for (std::uint32_t k = 0; k < membrane.body_count; ++k) {
            std::uint32_t const body = membrane.body + k;
            places_[body] = {.membrane = r,
                             .number = k,
                             .count = membrane.body_count,
                             .neighbours = neighbours,
                             .at_rest_mm = world.bodies.position_mm[body],
                             .radius_mm = world.bodies.radius_mm[body]};
        }
    }
}

bool MembraneFilter::may_collide(std::uint32_t body_a, std::uint32_t body_b) const {
    if (places_.empty()) {
        return true;
    }
    PlaceInRing const& one = places_[body_a];
    PlaceInRing const& other = places_[body_b];
    if (one.membrane == kNone || one.membrane != other.membrane) {
        return true;
    }
    std::uint32_t const steps = one.number > other.number ? one.number - other.number : other.number - one.number;
    bool const are_neighbours = std::min(steps, one.count - steps) <= one.neighbours;
    return !are_neighbours && length(other.at_rest_mm - one.at_rest_mm) >= one.radius_mm + other.radius_mm;
}

}  // namespace pogosim
