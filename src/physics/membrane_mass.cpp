#include "physics/membrane_mass.hpp"

#include <algorithm>
#include <cstdint>

namespace pogosim {

namespace {

constexpr float kMostMassRatio = 30.0F;

}  // namespace

void add_mass_to_membranes(World const& world, std::vector<float>& mass) {
    float heaviest = 0.0F;
    for (std::size_t i = 0; i < world.robots.size(); ++i) {
        if (world.spec_of(i).model.has_motors()) {
            heaviest = std::max(heaviest, mass[world.robots.body[i]]);
        }
    }
    for (Membrane const& membrane : world.membranes) {
        for (std::uint32_t i = membrane.body; i < membrane.body + membrane.body_count; ++i) {
            mass[i] = std::max(mass[i], heaviest / kMostMassRatio);
        }
    }
}

}  // namespace pogosim
