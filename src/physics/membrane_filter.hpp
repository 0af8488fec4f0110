// Which bodies of a soft membrane may collide with each other.
#pragma once

#include <cstdint>
#include <vector>

#include "world/world.hpp"

namespace pogosim {

/// Bodies that overlap at rest, as close neighbours in a membrane and those around a sharp corner do, must not push
/// each other away; the others of a membrane collide, so that it does not cross itself.
class MembraneFilter {
public:
    /// Takes the present shapes of the membranes as those at rest.
    explicit MembraneFilter(World const& world);

    /// Whether two bodies may collide; they may be bodies of membranes or not.
    bool may_collide(std::uint32_t body_a, std::uint32_t body_b) const;

private:
    struct PlaceInRing {
        std::uint32_t membrane = kNone;
        std::uint32_t number = 0;
        std::uint32_t count = 0;
        std::uint32_t neighbours = 0;  // the bodies up to this many places further on do not collide
        Vec2 at_rest_mm;
        float radius_mm = 0.0F;
    };
    std::vector<PlaceInRing> places_;  // for each body; empty without membranes
};

}  // namespace pogosim
