// The seam of a periodic world.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/polygon.hpp"
#include "world/world.hpp"

namespace pogosim {

class Seam {
public:
    /// Moves objects whose centre is out of bounds to the opposite side, as a whole. Bodies inside a soft membrane move
    /// together with the membrane, so that the seam does not separate them; until then they may be out of bounds, as
    /// parts of the membrane are. Returns the bodies that were moved, until the next call.
    std::vector<std::uint32_t> const& wrap_objects(World& world);

private:
    void shift(World& world, Object const& object, Vec2 way_mm);
    void wrap_with_contents(World& world, Object const& membrane);

    // Kept from step to step for their memory.
    std::vector<Object const*> rest_;  // rigid objects still to wrap
    Polygon line_;                     // of a membrane
    std::vector<std::uint32_t> moved_;
};

}  // namespace pogosim
